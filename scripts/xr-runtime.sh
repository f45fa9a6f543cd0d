#!/usr/bin/env bash
# Unpacks a real OpenXR runtime for the tests: Monado with its simulated and remote drivers, the OpenXR loader, software
# Vulkan, the validation layers and the one that writes every call down, from Debian trixie into a folder of its own. Nothing
# of the system is changed.
#
#   scripts/xr-runtime.sh [FOLDER]        default: ~/.cache/bowling/xr-runtime
#
# Prints the folder as its last line. A second call only checks what is there. Exit 3: this machine cannot have it (no
# Debian on x86-64); the tests then name themselves as skipped, except in continuous integration.
set -euo pipefail

# Debian 12 has no Monado, and a C library that is too old for trixie's: everything comes from trixie, its dynamic loader too.
readonly packages=monado-service,monado-cli,libopenxr1-monado,libopenxr-loader1,mesa-vulkan-drivers,libvulkan1,openxr-layer-apidump,openxr-layer-corevalidation,vulkan-validationlayers
readonly suite=trixie

cannot() {
  echo "xr-runtime: $1" >&2
  exit 3
}

if [ "$(uname -s)-$(uname -m)" != Linux-x86_64 ] || ! command -v apt-get >/dev/null; then
  cannot "the OpenXR runtime for tests is packed for Debian on x86-64 alone"
fi

folder=${1:-${XDG_CACHE_HOME:-$HOME/.cache}/bowling/xr-runtime}
mkdir -p "$folder"
folder=$(readlink -f "$folder")
root=$folder/root
libraries=$root/usr/lib/x86_64-linux-gnu

# Whole, and of these packages: an earlier version of this script may have unpacked fewer.
is_whole() {
  [ -s "$folder/manifest" ] && [ "$(cat "$folder/packages" 2>/dev/null)" = "$packages" ] \
    && (cd "$folder" && sha256sum --quiet --strict --check manifest >/dev/null 2>&1)
}

# What the tests start or load; a mirror that lacks one of them must fail here and not in a test.
parts() {
  printf '%s\n' ld packages lavapipe.json monado.json root/usr/bin/monado-service root/usr/bin/monado-ctl
  local library
  for library in ld-linux-x86-64.so.2 libc.so.6 libopenxr_monado.so libopenxr_loader.so.1 libvulkan.so.1 libvulkan_lvp.so \
    libVkLayer_khronos_validation.so; do
    printf '%s\n' "root/usr/lib/x86_64-linux-gnu/$library"
  done
  local layer
  for layer in core_validation api_dump; do
    printf '%s\n' "root/usr/lib/x86_64-linux-gnu/openxr/1/api_layers/libXrApiLayer_$layer.so"
  done
  (cd "$folder" && find api_layers root/usr/share/openxr -name '*.json' -type f)
}

unpack() {
  if ! command -v mmdebstrap >/dev/null; then
    # shellcheck source=scripts/system-packages.sh
    source "$(dirname "${BASH_SOURCE[0]}")/system-packages.sh"
    require_packages "mmdebstrap|unpacks the OpenXR runtime for the tests"
  fi
  # The mirror that this machine's own apt uses, with the keys that it trusts.
  local mirror
  mirror=$(apt-get indextargets --format '$(SITE)' 2>/dev/null | awk '/\/debian\/*$/ && !seen { print; seen = 1 }') && [ -n "$mirror" ] \
    || cannot "apt of this machine knows no Debian mirror to take the OpenXR runtime from"
  echo "xr-runtime: unpacking Monado and software Vulkan of Debian $suite (about half a minute, 300 MB) ..." >&2
  rm -rf "$root" "$folder/manifest"
  mmdebstrap --quiet --variant=extract --include="$packages" "$suite" "$root" "$mirror" >&2
}

describe() {
  local layer
  echo "$packages" >"$folder/packages"
  sed "s#\"library_path\": *\"[^\"]*\"#\"library_path\": \"$libraries/libvulkan_lvp.so\"#" \
    "$root/usr/share/vulkan/icd.d/lvp_icd.json" >"$folder/lavapipe.json"
  cat >"$folder/monado.json" <<JSON
{"file_format_version": "1.0.0", "runtime": {"name": "Monado", "library_path": "$libraries/libopenxr_monado.so"}}
JSON
  mkdir -p "$folder/api_layers"
  for layer in "$root"/usr/share/openxr/1/api_layers/explicit.d/*.json; do
    sed "s#\"/usr/lib#\"$root/usr/lib#" "$layer" >"$folder/api_layers/$(basename "$layer")"
  done
  # Starts a program with trixie's dynamic loader, so that one built here can load trixie's libraries.
  cat >"$folder/ld" <<SH
#!/bin/sh
export VK_DRIVER_FILES='$folder/lavapipe.json' XR_RUNTIME_JSON='$folder/monado.json' XR_API_LAYER_PATH='$folder/api_layers'
export VK_LAYER_PATH='$root/usr/share/vulkan/explicit_layer.d' NODEVICE_SELECT=1
exec '$libraries/ld-linux-x86-64.so.2' --library-path '$libraries:$root/usr/lib:$libraries/blas:$libraries/lapack:$libraries/pulseaudio:$libraries/openxr' "\$@"
SH
  chmod +x "$folder/ld"
}

if ! is_whole; then
  unpack
  describe
  (cd "$folder" && parts | sort | xargs sha256sum >manifest.new && mv manifest.new manifest)
fi
echo "$folder"
