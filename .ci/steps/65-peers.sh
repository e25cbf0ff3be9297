# Conversions against the engines themselves: three.js, Babylon.js and Filament's cmgen. Needs a network: npm packages are not kept.
need_gcc
need node nodejs
need npm npm
need cmgen libfilament-tools

check "conversions agree with three.js and Babylon.js" .ci/peers.sh npm "$work/peers"
check "conversions agree with Filament" .ci/peers.sh cmgen "$work/peers"
rm -rf "$work/peers"
