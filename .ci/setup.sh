# Sourced by ./demo and ./check: sees to it that what Obscura needs from the system is there.
#
#   set_up demo       the Vulkan loader and a driver, the libraries the window loads, a C linker, cargo
#   set_up tests      the same, and what the window tests need
#
# On apt systems what is missing is installed, in one go, and nothing is touched when nothing is
# missing. Elsewhere the missing things are named, with the command that installs them.
# shellcheck shell=bash

say() { printf 'obscura: %s\n' "$*" >&2; }
die() { say "error: $*"; exit 1; }

# Debian keeps ldconfig where ordinary users do not look.
has_library() { PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null | grep -F "$1 " >/dev/null; }

# The driver files that the Vulkan loader would read.
vulkan_manifests() {
    local folders="/etc/vulkan/icd.d /usr/share/vulkan/icd.d /usr/local/etc/vulkan/icd.d /usr/local/share/vulkan/icd.d"
    folders="$folders ${XDG_DATA_HOME:-${HOME:-}/.local/share}/vulkan/icd.d ${XDG_CONFIG_HOME:-${HOME:-}/.config}/vulkan/icd.d"
    local named="${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}" folder
    if [ -n "$named" ]; then
        tr ':' '\n' <<<"$named"
    else
        for folder in $folders; do
            if [ -d "$folder" ]; then find "$folder" -name '*.json'; fi
        done
    fi
}

# A device is there when the loader is, and a driver whose library exists: a software one, or one
# with hardware to drive (a driver alone, as in containers, makes no device).
has_vulkan() {
    has_library libvulkan.so.1 || return 1
    local manifest library
    while IFS= read -r manifest; do
        if [ ! -r "$manifest" ]; then continue; fi
        library=$(sed -n 's/.*"library_path"[[:space:]]*:[[:space:]]*"\([^"]*\)".*/\1/p' "$manifest" | head -n 1)
        case "$library" in
            "") continue ;;
            /*) [ -e "$library" ] || continue ;;
            */*) [ -e "$(dirname "$manifest")/$library" ] || continue ;;
            *) has_library "$library" || continue ;;
        esac
        case "$library" in *lvp* | *swiftshader*) return 0 ;; esac
        if compgen -G '/dev/dri/renderD*' >/dev/null || [ -e /dev/nvidia0 ] || [ -e /dev/dxg ]; then return 0; fi
    done <<<"$(vulkan_manifests)"
    return 1
}

# What winit loads at run time, and the Debian package of each.
window_libraries="\
libX11.so.6 libx11-6
libX11-xcb.so.1 libx11-xcb1
libxcb.so.1 libxcb1
libXcursor.so.1 libxcursor1
libXi.so.6 libxi6
libxkbcommon.so.0 libxkbcommon0
libxkbcommon-x11.so.0 libxkbcommon-x11-0
libwayland-client.so.0 libwayland-client0"

needed_in_words="a Vulkan loader and driver (Mesa's lavapipe draws without a GPU), a C compiler, the X11, Xcursor, Xi, xkbcommon and Wayland client libraries; for ./check Xvfb and xdotool"

# Debian packages for what is missing, one a line. With `needed` only what nothing works without, with
# `tests` also what the window tests need.
missing_packages() {
    local library package
    has_vulkan || printf '%s\n' libvulkan1 mesa-vulkan-drivers
    command -v cc >/dev/null || printf '%s\n' gcc
    [ -e /usr/include/stdio.h ] || printf '%s\n' libc6-dev
    if [ "${1:-}" = needed ]; then return; fi
    while read -r library package; do
        has_library "$library" || printf '%s\n' "$package"
    done <<<"$window_libraries"
    if [ "${1:-}" = tests ]; then
        command -v Xvfb >/dev/null || printf '%s\n' xvfb
        command -v xdotool >/dev/null || printf '%s\n' xdotool
    fi
}

install_with_apt() {
    local script='apt-get update -q || echo "obscura: apt-get update failed; going on with the lists that are there" >&2
        apt-get install -q -y --no-install-recommends -o DPkg::Lock::Timeout=300 "$@"'
    if [ "$(id -u)" = 0 ]; then
        DEBIAN_FRONTEND=noninteractive sh -c "$script" sh "$@" </dev/null >&2
    elif command -v sudo >/dev/null && [ -t 0 ]; then
        sudo env DEBIAN_FRONTEND=noninteractive sh -c "$script" sh "$@" >&2
    elif command -v sudo >/dev/null; then
        sudo -n env DEBIAN_FRONTEND=noninteractive sh -c "$script" sh "$@" </dev/null >&2
    else
        return 1
    fi
}

set_up_linux() {
    local missing
    if ! PATH="$PATH:/usr/sbin:/sbin" command -v ldconfig >/dev/null; then
        say "no ldconfig here, so what is missing cannot be seen; needed are $needed_in_words"
        return
    fi
    missing=$(missing_packages "${1:-}" | sort -u | tr '\n' ' ')
    if [ -z "$missing" ]; then return; fi
    if command -v apt-get >/dev/null; then
        say "installing what is missing: $missing"
        # shellcheck disable=SC2086 # one word a package
        install_with_apt $missing || say "could not install it; as root: apt-get install $missing"
    else
        say "some of what Obscura needs is missing (by its Debian names: $missing); install it with:"
        if command -v dnf >/dev/null; then
            say "  sudo dnf install gcc vulkan-loader mesa-vulkan-drivers libX11 libX11-xcb libxcb libXcursor libXi libxkbcommon libxkbcommon-x11 libwayland-client xorg-x11-server-Xvfb xdotool"
        elif command -v pacman >/dev/null; then
            say "  sudo pacman -S --needed gcc vulkan-icd-loader vulkan-swrast libx11 libxcb libxcursor libxi libxkbcommon libxkbcommon-x11 wayland xorg-server-xvfb xdotool"
        elif command -v zypper >/dev/null; then
            say "  sudo zypper install gcc libvulkan1 libvulkan_lvp libX11-6 libX11-xcb1 libxcb1 libXcursor1 libXi6 libxkbcommon0 libxkbcommon-x11-0 libwayland-client0 xorg-x11-server-Xvfb xdotool"
        else
            say "  your system's package manager: $needed_in_words"
        fi
    fi
    # A window's libraries matter only where a window can open; the rest matters everywhere.
    local level=needed
    if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then level=""; fi
    if [ "${1:-}" = tests ]; then level=tests; fi
    missing=$(missing_packages "$level" | sort -u | tr '\n' ' ')
    if [ -n "$missing" ]; then die "still missing: $missing"; fi
}

set_up() {
    case "$(uname -s)" in
        Linux) set_up_linux "$@" ;;
        Darwin) command -v cc >/dev/null || die "no C compiler; install it with: xcode-select --install" ;;
        *) command -v cc >/dev/null || say "no C compiler found; the build may need one" ;;
    esac
    if ! command -v cargo >/dev/null && [ -x "${CARGO_HOME:-${HOME:-}/.cargo}/bin/cargo" ]; then
        PATH="${CARGO_HOME:-${HOME:-}/.cargo}/bin:$PATH"
        export PATH
    fi
    command -v cargo >/dev/null || die "no cargo; install Rust with: curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh"
}
