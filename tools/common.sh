# shellcheck shell=bash
# What the tools share: the scene that they show, and what they ask of a machine. Sourced, never run;
# changes nothing.

# The bundled mountain: one count of the PNG is one metre; a cell is 3 arc-seconds at 44.3 degrees
# north. Under the bundled sky and a low sun, ten degrees high.
# shellcheck disable=SC2034 # used where this is sourced
demo_field=(assets/mt_washington_256.png --cell "66,92.6")
# shellcheck disable=SC2034
demo_scene=("${demo_field[@]}" --env assets/sky_512x256.hdr --sun "300,10,0.53,15")

# Of every shader with its path, and of how they are compiled. tools/shaders writes it beside the SPIR-V.
glsl_checksum_file=shaders_glsl/compiled/glsl.sha256
glsl_checksum() {
    find shaders_glsl tests/gpu/bake/decoders/shaders build/compile.rs -type f ! -path 'shaders_glsl/compiled/*' -print0 |
        LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1
}

# Non-root users of Debian have no sbin on their PATH, and ldconfig lives there.
PATH=$PATH:/usr/sbin:/sbin

# Where Chromium's packages put SwiftShader and the validation layer they were tested with.
chromium_folders=(/usr/lib/chromium /usr/lib64/chromium /usr/lib/chromium-browser)

# library_path of a loader manifest as a file that exists and whose own libraries all do; fails
# if there is none. A manifest left behind by a removed driver is the common case.
library_of() {
    local manifest=$1 library
    library=$(sed -nE 's/.*"library_path"[[:space:]]*:[[:space:]]*"([^"]+)".*/\1/p' "$manifest" | head -n 1)
    case $library in
        '') return 1 ;;
        /*) ;;
        # With a slash the path is relative to the manifest, without one the linker searches.
        */*) library=$(dirname "$manifest")/$library ;;
        *) library=$(ldconfig -p 2>/dev/null | sed -nE "s|^[[:space:]]*${library//./\\.} .*=> (.+)$|\1|p" | head -n 1) ;;
    esac
    [ -f "$library" ] || return 1
    # Not a pipe into `grep -q`: that one stops reading early, which pipefail takes for a failure.
    local needs
    needs=$(ldd "$library" 2>/dev/null) || return 1
    [[ $needs != *"not found"* ]] || return 1
    printf '%s\n' "$library"
}

# The driver manifests the Vulkan loader would read, one a line, in its own order.
driver_manifests() {
    local listed=${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}} entry
    local -a entries
    if [ -n "$listed" ]; then
        # The two variables replace the search, they do not add to it.
        IFS=: read -ra entries <<<"$listed"
    else
        IFS=: read -ra entries <<<"${XDG_CONFIG_HOME:-${HOME:-}/.config}/vulkan/icd.d:/etc/xdg/vulkan/icd.d:/etc/vulkan/icd.d:${XDG_DATA_HOME:-${HOME:-}/.local/share}/vulkan/icd.d:/usr/local/share/vulkan/icd.d:/usr/share/vulkan/icd.d"
    fi
    for entry in "${entries[@]}"; do
        if [ -d "$entry" ]; then
            find -L "$entry" -maxdepth 1 -name '*.json' | sort
        elif [ -f "$entry" ]; then
            printf '%s\n' "$entry"
        fi
    done
}

# The first manifest with a library behind it whose file name matches the pattern; fails if none.
working_driver() {
    local pattern=$1 manifest
    while IFS= read -r manifest; do
        # shellcheck disable=SC2053 # the right-hand side is a pattern on purpose
        if [[ $(basename "$manifest") == $pattern ]] && library_of "$manifest" >/dev/null; then
            printf '%s\n' "$manifest"
            return 0
        fi
    done < <(driver_manifests)
    return 1
}

# The reference driver of the tests, wherever the caller's own variables point.
lavapipe_manifest() {
    VK_DRIVER_FILES='' VK_ICD_FILENAMES='' working_driver 'lvp_icd*.json'
}

# A file of Chromium's by name; fails if there is none.
chromium_file() {
    local folder
    for folder in "${chromium_folders[@]}"; do
        if [ -f "$folder/$1" ]; then
            printf '%s\n' "$folder/$1"
            return 0
        fi
    done
    return 1
}

# A loader manifest of SwiftShader. Chromium's own names the library relative to itself and an API of 1.0.
swiftshader_manifest() {
    cat <<JSON
{
    "file_format_version": "1.0.0",
    "ICD": { "library_path": "$(chromium_file libvk_swiftshader.so)", "api_version": "1.3.0" }
}
JSON
}

# Whether Debian's own Python has a module.
python_has() { # MODULE
    /usr/bin/python3 -c "import $1" 2>/dev/null
}

# Whether GDAL's tools are there, with its validator of Cloud Optimized GeoTIFFs.
has_gdal() {
    command -v gdalinfo >/dev/null && python_has osgeo_utils.samples.validate_cloud_optimized_geotiff
}

# Whether NumPy is there, and GDAL, whose values its arrays are compared with.
has_numpy() {
    has_gdal && python_has numpy
}
