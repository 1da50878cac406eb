#!/bin/sh
# Installs what Visavis needs beside Rust, where it is missing: a Vulkan driver that works without a graphics card, the
# libraries of a window, and Xvfb, in which the tests open real windows. Safe to run again: it then does nothing.
set -eu

case "$(uname -s)" in
Linux) ;;
*)
    echo "setup: nothing to install on $(uname -s)"
    exit 0
    ;;
esac

missing=""
library() { # FILE PACKAGE: the dynamic linker knows FILE, or PACKAGE brings it
    /sbin/ldconfig -p | grep -q "$1" || missing="$missing $2"
}
program() { # NAME PACKAGE
    command -v "$1" >/dev/null 2>&1 || missing="$missing $2"
}

library libvulkan.so.1 libvulkan1
library libEGL.so.1 libegl1
library libX11.so.6 libx11-6
library libX11-xcb.so.1 libx11-xcb1
library libXcursor.so.1 libxcursor1
library libXi.so.6 libxi6
library libXrandr.so.2 libxrandr2
library libxkbcommon.so.0 libxkbcommon0
library libxkbcommon-x11.so.0 libxkbcommon-x11-0
library libwayland-client.so.0 libwayland-client0
program Xvfb xvfb
program cc gcc
[ -e /usr/include/stdio.h ] || missing="$missing libc6-dev"
found=""
for folder in /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d; do
    ls "$folder"/*.json >/dev/null 2>&1 && found=yes
done
[ -n "$found" ] || missing="$missing mesa-vulkan-drivers"

if [ -n "$missing" ]; then
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "setup: please install the counterparts of these Debian packages:$missing" >&2
        exit 1
    fi
    as_root=""
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            echo "setup: please install as root: apt-get install$missing" >&2
            exit 1
        fi
        as_root=sudo
    fi
    echo "setup: installing$missing"
    $as_root apt-get update -qq
    # shellcheck disable=SC2086 # a list of packages
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing
fi

if ! command -v cargo >/dev/null 2>&1; then
    echo "setup: Rust is missing; install it from rustup.rs (1.95 or newer)" >&2
    exit 1
fi
