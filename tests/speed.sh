#!/usr/bin/env bash
# Is a program slower than another? Renders the same films with both, in pairs whose order changes (ABBA), and compares
# their samples per second of CPU time. Start-up (reading the scene, building its tree, compiling shaders) is left out:
# it is measured by renders of one sample per pixel. Wants an idle machine.
#
#     tests/speed.sh [--quick] OLD_VISAVIS NEW_VISAVIS [RUNS]
#
# RUNS pairs of each case: 21, or 5 if --quick. CASES="mesh gpu" leaves out cases whose names hold none of these words.
# A ratio above 1 says that the new one is faster. Its interval holds the true median with a probability of at least 95 %
# (order statistics); with fewer than 6 pairs there is none, and it is all that was measured.
set -euo pipefail

usage() {
    sed -n '2,10s/^# \{0,1\}//p' "$0" >&2
    exit 2
}

runs=21
starts=5
if [ "${1:-}" = --quick ]; then
    runs=5
    starts=3
    shift
fi
[ $# -ge 2 ] || usage
old=$(realpath "$1")
new=$(realpath "$2")
runs=${3:-$runs}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A landscape of a million triangles (707 x 707 cells) and a lamp.
make_mesh() {
    awk 'BEGIN {
        n = 707
        print "camera = { eye = [5, 3, 12], target = [5, 0.5, 4], fov_y = 45 }"
        print "sky = { radiance = [0.2, 0.3, 0.5] }"
        print "[material.ground]\ndiffuse = { albedo = [0.5, 0.6, 0.4] }"
        print "[material.lamp]\nemissive = { radiance = [9, 8, 7] }"
        print "[[rectangle]]\ncorner = [7, 2.5, 3]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]\nmaterial = \"lamp\""
        print "[[mesh]]\nmaterial = \"ground\"\npositions = ["
        for (i = 0; i <= n; i++) for (k = 0; k <= n; k++)
            printf "[%.4f,%.4f,%.4f],\n", i / 70.7, ((i * i * 7 + k * k * 13 + i * k * 5) % 64) / 1024, k / 70.7
        print "]\ntriangles = ["
        for (i = 0; i < n; i++) for (k = 0; k < n; k++) {
            a = i * (n + 1) + k; b = a + n + 1
            printf "[%d,%d,%d],[%d,%d,%d],\n", a, a + 1, b, b, a + 1, b + 1
        }
        print "]"
    }' >"$folder/mesh.toml"
}

# Seconds of CPU time on one thread, and on one of llvmpipe's: user + system, but of the mesh without the system's, which
# is all start-up (new pages for the scene) and varies by a second.
seconds_of() { # PROGRAM SPP SCENE OPTIONS...
    local program=$1 spp=$2 TIMEFORMAT='%U %S'
    shift 2
    if ! { time RAYON_NUM_THREADS=1 LP_NUM_THREADS=1 "$program" render "$@" --spp "$spp" -o "$folder/out.exr" \
        >"$folder/said" 2>&1; } 2>"$folder/time"; then
        cat "$folder/said" >&2
        return 1
    fi
    case $1 in
    */mesh.toml) awk '{ print $1 }' "$folder/time" ;;
    *) awk '{ print $1 + $2 }' "$folder/time" ;;
    esac
}

median() {
    sort -g | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'
}

# Old and new in turn, in the order of ABBA: lines "old new"
pairs() { # COUNT SPP ARGUMENTS...
    local count=$1 spp=$2 i a b
    shift 2
    for ((i = 0; i < count; i++)); do
        if ((i % 2 == 0)); then
            a=$(seconds_of "$old" "$spp" "$@")
            b=$(seconds_of "$new" "$spp" "$@")
        else
            b=$(seconds_of "$new" "$spp" "$@")
            a=$(seconds_of "$old" "$spp" "$@")
        fi
        echo "$a $b"
    done
}

is_wanted() { # NAME
    local word
    [ -n "${CASES:-}" ] || return 0
    for word in $CASES; do
        case $1 in *"$word"*) return 0 ;; esac
    done
    return 1
}

measure() { # NAME WIDTHxHEIGHT SPP SCENE OPTIONS...
    local name=$1 size=$2 spp=$3 pixels start_old start_new
    is_wanted "$name" || return 0
    shift 3
    pixels=$((${size%x*} * ${size#*x}))
    pairs "$starts" 1 "$@" --size "$size" >"$folder/starts"
    start_old=$(cut -d' ' -f1 "$folder/starts" | median)
    start_new=$(cut -d' ' -f2 "$folder/starts" | median)
    pairs "$runs" "$spp" "$@" --size "$size" | awk -v so="$start_old" -v sn="$start_new" -v samples=$((pixels * (spp - 1))) '
        { print ($1 - so) / ($2 - sn), samples / ($1 - so) / 1e6, samples / ($2 - sn) / 1e6 }' >"$folder/ratios"
    sort -g "$folder/ratios" | awk -v name="$name" -v so="$start_old" -v sn="$start_new" \
        -v mo="$(cut -d' ' -f2 "$folder/ratios" | median)" -v mn="$(cut -d' ' -f3 "$folder/ratios" | median)" '
        { r[NR] = $1 }
        END {
            # the largest k with P(fewer than k of n fair coins show heads) <= 2.5 %
            n = NR; p = 0.5 ^ n; below = 0; k = 1
            for (i = 0; i < n / 2; i++) {
                below += p
                if (below <= 0.025) k = i + 1
                p *= (n - i) / (i + 1)
            }
            m = n % 2 ? r[(n + 1) / 2] : (r[n / 2] + r[n / 2 + 1]) / 2
            printf "%-24s %8.3f   %.3f .. %.3f %5d %9.3f %9.3f %8.2f %8.2f\n", name, m, r[k], r[n + 1 - k], n, mo, mn, so, sn
        }'
}

heading='%-24s %8s   %-14s %5s %9s %9s %8s %8s\n'
# shellcheck disable=SC2059 # one format of two lines
printf "$heading" '' ratio 'interval of' '' 'old M' 'new M' 'old s' 'new s'
# shellcheck disable=SC2059
printf "$heading" case new/old 'its median' pairs samples/s samples/s start-up start-up

has_lanes() {
    "$old" render cornell --lanes "$1" --size 8x8 --spp 1 -o "$folder/out.exr" >"$folder/said" 2>&1 && return 0
    echo "left out, $1: $(tail -n 1 "$folder/said")"
    return 1
}

# Sizes and samples make runs of about a second, and of three where the mesh is read before.
if has_lanes avx512; then
    measure 'cornell path avx512' 256x256 256 cornell --lanes avx512
    measure 'whitted path avx512' 256x256 448 whitted --lanes avx512
fi
if has_lanes avx2; then
    measure 'cornell path avx2' 256x256 144 cornell --lanes avx2
    measure 'whitted path avx2' 256x256 224 whitted --lanes avx2
fi
measure 'cornell whitted' 256x256 448 cornell --technique whitted --device cpu
measure 'whitted whitted' 256x256 256 whitted --technique whitted --device cpu
measure 'cornell path gpu' 256x144 32 cornell --device gpu
measure 'whitted path gpu' 256x144 160 whitted --device gpu
for lanes in avx512 avx2; do
    if ! is_wanted "mesh path $lanes" || ! has_lanes $lanes; then
        continue
    fi
    [ -e "$folder/mesh.toml" ] || make_mesh
    measure "mesh path $lanes" 256x144 96 "$folder/mesh.toml" --lanes $lanes
done
