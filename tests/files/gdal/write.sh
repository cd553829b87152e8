#!/usr/bin/env bash
# Writes the GeoTIFFs beside it with GDAL (Debian's gdal-bin 3.6.2 wrote the committed ones).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# 7 columns, 5 rows, a hill; the first pixel's corner is at 500 km east, 5,100 km north.
awk 'BEGIN { print "ncols 7\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 1"
    for (r = 0; r < 5; r++) { for (c = 0; c < 7; c++) printf "%d ", 100 - 9 * (c - 3) ^ 2 - 7 * (r - 2) ^ 2; print "" } }' \
    >"$scratch/hill.asc"
write() { # CRS OUT OPTIONS...
    local crs=$1 out=$2
    shift 2
    rm -f "$out"
    gdal_translate -q -ot Float32 -a_srs "$crs" -a_ullr 500000 5100000 500070 5099900 "$@" "$scratch/hill.asc" "$out"
}
write EPSG:32633 utm.tif
write EPSG:32633 zstd.tif -co COMPRESS=ZSTD -co PREDICTOR=3
write EPSG:32633 scaled.tif -ot Int16 -co COMPRESS=DEFLATE -co PREDICTOR=2 -a_scale 0.5 -a_offset 1000
# Its cells are of 10 and 20 units at about 45 degrees north.
rm -f mercator.tif
gdal_translate -q -ot Float32 -a_srs EPSG:3857 -a_ullr 1500000 5621521 1500070 5621421 "$scratch/hill.asc" mercator.tif
# EPSG:6360 is NAVD88 height in US survey feet.
write EPSG:32633+6360 utm_point_feet.tif -mo AREA_OR_POINT=Point
