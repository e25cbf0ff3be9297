// Compares the sets that peers.c prints with what three.js and Babylon.js make of the same light.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const load = (path) => import(pathToFileURL(`${process.argv[3]}/node_modules/${path}`).href);
const THREE = await load("three/build/three.module.js");
const BABYLON = await load("@babylonjs/core/Maths/sphericalPolynomial.js");
const { Vector3 } = await load("@babylonjs/core/Maths/math.vector.js");
const { Color3 } = await load("@babylonjs/core/Maths/math.color.js");

const ours = JSON.parse(readFileSync(process.argv[2], "utf8"));
const triple = (array, i) => array.slice(3 * i, 3 * i + 3);
let failed = 0;

function compare(what, theirs, expected, tolerance) {
    const scale = Math.max(...expected.map(Math.abs));
    const error = Math.max(...theirs.map((x, i) => Math.abs(x - expected[i]))) / scale;
    const passed = theirs.length === expected.length && error <= tolerance;
    console.log(`${passed ? "ok    " : "FAILED"} ${what}: ${error.toExponential(1)} of ${tolerance}`);
    failed += passed ? 0 : 1;
}

// three.js: a light of mean `value` from one direction has integral 4 pi value.
const three = new THREE.SphericalHarmonics3();
for (let i = 0; i < ours.values.length; i++) {
    const basis = [];
    THREE.SphericalHarmonics3.getBasisAt(new THREE.Vector3(...triple(ours.dirs, i)), basis);
    for (let k = 0; k < 9; k++) three.coefficients[k].x += 4 * Math.PI * ours.values[i] * basis[k];
}
compare("three.js coefficients", three.coefficients.map((v) => v.x), ours.orthonormal, 1e-5);
three.coefficients.forEach((v, k) => (v.x = ours.orthonormal[k]));
const normals = ours.radiance.map((_, i) => new THREE.Vector3(...triple(ours.normals, i)));
compare("three.js getAt", normals.map((n) => three.getAt(n, new THREE.Vector3()).x), ours.radiance, 1e-5);
compare("three.js getIrradianceAt / pi", normals.map((n) => three.getIrradianceAt(n, new THREE.Vector3()).x / Math.PI), ours.irradiance, 1e-5);

// Babylon.js
const names = ["l00", "l1_1", "l10", "l11", "l2_2", "l2_1", "l20", "l21", "l22"];
const harmonics = new BABYLON.SphericalHarmonics();
for (let i = 0; i < ours.values.length; i++)
    harmonics.addLight(new Vector3(...triple(ours.dirs, i)), new Color3(1, 1, 1).scale(ours.values[i]), 4 * Math.PI);
compare("Babylon.js SphericalHarmonics", names.map((n) => harmonics[n].x), ours.phase, 1e-5);
const terms = ["x", "y", "z", "xx", "yy", "zz", "yz", "zx", "xy"];
const polynomial = BABYLON.SphericalPolynomial.FromHarmonics(harmonics);
compare("Babylon.js SphericalPolynomial", terms.map((t) => polynomial[t].x), ours.babylon, 1e-4); // its constants: 0.886277
const environment = BABYLON.SphericalPolynomial.FromArray(ours.babylon_environment.map((x) => [x, x, x]));
compare("Babylon.js preScaledHarmonics", names.map((n) => environment.preScaledHarmonics[n].x), ours.unity, 1e-4);
process.exit(failed ? 1 : 0);
