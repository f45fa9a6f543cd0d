# Sourced by play.sh and test.sh: installs what Debian and Ubuntu need beside a Rust toolchain.
#
#   require_packages "name|why" ...
#
# Says which packages are missing and why each is needed, then installs them with apt (through sudo when not root).
# Where there is no apt it prints the list and stops only if a build would fail for certain.

build_packages=(
  "gcc|links the program"
  "libc6-dev|links the program"
  "pkg-config|finds libudev and libasound"
  "libudev-dev|gamepads (gilrs)"
  "libasound2-dev|sound (kira)"
)
graphics_packages=(
  "libvulkan1|Vulkan loader"
  "mesa-vulkan-drivers|Vulkan drivers, with one for machines that have no GPU"
  "libegl1|OpenGL without a screen, where Vulkan fails"
  "libgl1-mesa-dri|OpenGL drivers"
)
window_packages=(
  "libx11-xcb1|the window on X11"
  "libxcursor1|the window on X11"
  "libxi6|mouse and keys on X11"
  "libxrandr2|screens on X11"
  "libxkbcommon-x11-0|keyboard layout on X11"
  "libwayland-client0|the window on Wayland"
)
test_packages=(
  "xvfb|a screen in memory, for the window's test"
  "xdotool|real key and mouse events, for the window's test"
  "mmdebstrap|unpacks the OpenXR runtime, for the headset's tests"
  "iproute2|a network of their own, for the headset's tests"
)

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

require_packages() {
  local entry name missing=()
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    echo "This system has no apt. If the build or the start fails, install the equivalents of:" >&2
    for entry in "$@"; do echo "  ${entry%%|*}: ${entry#*|}" >&2; done
    return 0
  fi
  for entry in "$@"; do
    name=${entry%%|*}
    is_installed "$name" && continue
    [ ${#missing[@]} -eq 0 ] && echo "Missing system packages:" >&2
    echo "  $name: ${entry#*|}" >&2
    missing+=("$name")
  done
  [ ${#missing[@]} -eq 0 ] && return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Installing them needs root and there is no sudo. As root: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing them with apt ..." >&2
  # A machine whose package lists were never fetched, or are old, fails the first install: refresh once, then try.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq >&2 || true
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2; then
    echo "apt could not install: ${missing[*]}. Install them by hand and start again." >&2
    return 1
  fi
}

require_cargo() {
  command -v cargo >/dev/null && return 0
  if [ -x "$HOME/.cargo/bin/cargo" ]; then
    PATH="$HOME/.cargo/bin:$PATH"
    return 0
  fi
  echo "No Rust toolchain found: install Rust 1.95 or newer (rustup, or your system's package) and start again." >&2
  return 1
}

# Where there is no desktop session this variable is unset, and drivers complain about it on every start.
provide_runtime_folder() {
  if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    export XDG_RUNTIME_DIR="${CARGO_TARGET_DIR:-${root:-$PWD}/target}/runtime"
    mkdir -p "$XDG_RUNTIME_DIR"
    chmod 700 "$XDG_RUNTIME_DIR"
  fi
}
