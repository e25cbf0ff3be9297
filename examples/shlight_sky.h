/* shlight_sky.h - the panorama that shlight carries: a clear sky with a sun over grey-brown ground, in units of the zenith's luminance.
 *
 * The sky is the CIE standard clear sky: ISO 15469:2004 (CIE S 011), type 12. The sun is a disc of 2 degrees half-angle, 7.5 times
 * the real one's, so that a texel resolves it, and as much dimmer: at normal incidence it gives four times the irradiance that the
 * sky gives to level ground, as on a clear day with some haze. The ground is Lambertian and reflects what sky and sun give it.
 */
#ifndef SHLIGHT_SKY_H
#define SHLIGHT_SKY_H

#include "shlight_image.h"

#define SHLIGHT_PI 3.14159265358979323846 /* pi */

enum { SHLIGHT_SKY_WIDTH = 1024, SHLIGHT_SKY_HEIGHT = 512 };

static const double shlight_sun_elevation = 38.0 * SHLIGHT_PI / 180.0;
static const double shlight_sun_column = 0.36; /* fraction of the width */
static const double shlight_sun_radius = 2.0 * SHLIGHT_PI / 180.0;
static const double shlight_sun_over_sky = 4.0; /* irradiance at normal incidence over that of the sky on level ground */

/* CIE gradation: zenith to horizon, by the cosine of the zenith angle. */
static double shlight_sky_gradation(double cos_zenith) {
    return 1.0 - exp(-0.32 / cos_zenith);
}

/* CIE indicatrix: scattering, by the angle to the sun. */
static double shlight_sky_indicatrix(double angle) {
    const double c = cos(angle);
    return 1.0 + 10.0 * (exp(-3.0 * angle) - exp(-3.0 * SHLIGHT_PI / 2.0)) + 0.45 * c * c;
}

/* Radiance of the sky without the sun's disc. Blue where air scatters once, white where it scatters often: to the horizon and sun. */
static void shlight_sky_radiance(double cos_zenith, double angle, double rgb[3]) {
    static const double blue[3] = { 0.28, 0.72, 1.75 }, white[3] = { 0.94, 1.00, 1.08 };
    const double zenith = shlight_sky_gradation(1.0) * shlight_sky_indicatrix(SHLIGHT_PI / 2.0 - shlight_sun_elevation);
    const double luminance = shlight_sky_gradation(cos_zenith) * shlight_sky_indicatrix(angle) / zenith;
    const double haze = 1.0 - (1.0 - exp(-4.0 * angle)) * pow(cos_zenith, 0.35);
    for (int k = 0; k < 3; k++)
        rgb[k] = luminance * (blue[k] + (white[k] - blue[k]) * haze);
}

/* Fills the rows above the horizon with sky, and adds up its irradiance / pi on level ground. */
static void shlight_sky_dome(shlight_image *image, double irradiance[3]) {
    irradiance[0] = irradiance[1] = irradiance[2] = 0.0;
    for (int y = 0; y < image->height / 2; y++) {
        const double polar = SHLIGHT_PI * (y + 0.5) / image->height, cosine = cos(polar);
        const double weight = 2.0 * SHLIGHT_PI / image->height * sin(polar) * cosine / image->width;
        for (int x = 0; x < image->width; x++) {
            const double azimuth = 2.0 * SHLIGHT_PI * ((x + 0.5) / image->width - shlight_sun_column);
            const double to_sun = cosine * sin(shlight_sun_elevation) + sin(polar) * cos(shlight_sun_elevation) * cos(azimuth);
            float *texel = image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
            double rgb[3];
            shlight_sky_radiance(cosine, acos(to_sun > 1.0 ? 1.0 : to_sun), rgb);
            for (int k = 0; k < 3; k++) {
                texel[k] = (float)rgb[k];
                irradiance[k] += weight * rgb[k];
            }
        }
    }
}

/* Adds the sun, its edge spread over a texel, and its share to the irradiance on level ground. */
static void shlight_sky_sun(shlight_image *image, double irradiance[3]) {
    static const double colour[3] = { 1.16, 1.00, 0.74 };
    const double sine = sin(shlight_sun_elevation), texel_size = SHLIGHT_PI / image->height, edge = sin(shlight_sun_radius);
    const double direct = shlight_sun_over_sky * irradiance[1], radiance = direct / (edge * edge);
    for (int y = 0; y < image->height / 2; y++) {
        const double polar = SHLIGHT_PI * (y + 0.5) / image->height;
        for (int x = 0; x < image->width; x++) {
            const double azimuth = 2.0 * SHLIGHT_PI * ((x + 0.5) / image->width - shlight_sun_column);
            const double to_sun = cos(polar) * sine + sin(polar) * cos(shlight_sun_elevation) * cos(azimuth);
            const double inside = to_sun < 0.9 ? 0.0 : (shlight_sun_radius - acos(to_sun > 1.0 ? 1.0 : to_sun)) / texel_size + 0.5;
            float *texel = image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
            if (inside <= 0.0)
                continue;
            for (int k = 0; k < 3; k++)
                texel[k] += (float)(radiance * colour[k] * (inside < 1.0 ? inside : 1.0));
        }
    }
    for (int k = 0; k < 3; k++)
        irradiance[k] += direct * sine * colour[k];
}

/* Fills the rows below the horizon with ground, which fades into the haze towards the horizon. */
static void shlight_sky_ground(shlight_image *image, const double irradiance[3]) {
    static const double albedo[3] = { 0.18, 0.15, 0.10 };
    for (int y = image->height / 2; y < image->height; y++) {
        const float *horizon = image->pixels + 3 * (size_t)(image->height / 2 - 1) * (size_t)image->width;
        const double depth = -cos(SHLIGHT_PI * (y + 0.5) / image->height), haze = 0.6 * exp(-depth / 0.03);
        for (int x = 0; x < image->width; x++) {
            float *texel = image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
            for (int k = 0; k < 3; k++)
                texel[k] = (float)(albedo[k] * irradiance[k] * (1.0 - haze) + (double)horizon[3 * x + k] * haze);
        }
    }
}

/* The built-in panorama; NULL, or what is wrong. */
static const char *shlight_sky(shlight_image *image) {
    double irradiance[3];
    memset(image, 0, sizeof *image);
    image->width = SHLIGHT_SKY_WIDTH;
    image->height = SHLIGHT_SKY_HEIGHT;
    image->channels = 3;
    image->format = "built-in clear sky with a sun";
    const char *error = shlight_allocate(image);
    if (error)
        return error;
    shlight_sky_dome(image, irradiance);
    shlight_sky_sun(image, irradiance);
    shlight_sky_ground(image, irradiance);
    return NULL;
}

#endif /* SHLIGHT_SKY_H */
