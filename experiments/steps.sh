# Sourced by experiments/reproduce and tests/run: the packages, and steps that show progress and stop at the first failure.
# shellcheck shell=bash

# Debian package, and what shows on other systems that it is there.
packages=(
    "g++                      command:g++"
    "cmake                    command:cmake"
    "ninja-build              command:ninja"
    "pkg-config               command:pkg-config"
    "git                      command:git"
    "libvulkan-dev            header:vulkan/vulkan_raii.hpp"
    "mesa-vulkan-drivers      file:/usr/share/vulkan/icd.d"
    "vulkan-validationlayers  file:/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json"
    "glslang-dev              header:glslang/Public/ShaderLang.h"
    "glslang-tools            command:glslangValidator"
    "spirv-cross              command:spirv-cross"
    "spirv-tools              command:spirv-opt"
    "libopenimageio-dev       header:OpenImageIO/imagebufalgo.h"
    "libembree-dev            header:embree3/rtcore.h"
    "libtinygltf-dev          header:tiny_gltf.h"
    "libassimp-dev            header:assimp/Importer.hpp"
    "libtomlplusplus-dev      header:toml++/toml.h"
    "nlohmann-json3-dev       header:nlohmann/json.hpp"
    "libfmt-dev               header:fmt/format.h"
    "libcli11-dev             header:CLI/CLI.hpp"
    "libglm-dev               header:glm/glm.hpp"
    "libxxhash-dev            header:xxhash.h"
    "libgtest-dev             header:gtest/gtest.h"
    "libgmock-dev             header:gmock/gmock.h"
    "fonts-dejavu-core        file:/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
    "libbenchmark-dev         header:benchmark/benchmark.h"
    "python3-matplotlib       module:matplotlib"
    "python3-pandas           module:pandas"
    "python3-scipy            module:scipy"
    "python3-openimageio      module:OpenImageIO"
    "python3-jinja2           module:jinja2"
    "python3-pil              module:PIL"
    "libjs-chart.js           file:/usr/share/javascript/chart.js/chart.min.js"
)

build=build
logs=$build/log
install=yes
started=$SECONDS
step_number=0
monitor=

fail() {
    stop_monitor
    echo "$(basename "$0"): $*" >&2
    exit 1
}

duration_text() {
    printf '%d:%02d' $(($1 / 60)) $(($1 % 60))
}

# ---- Steps. plan SECONDS … first: what each step takes, so that the remaining time is known.
plan() {
    expected=("$@")
    step_count=$#
}

# What the finished steps were expected to take, and took: the rest is scaled by it.
done_expected=0
done_spent=0

scaled_s() { # seconds
    ((done_expected >= 60)) && echo $(($1 * done_spent / done_expected)) || echo "$1"
}

remaining_s() {
    local sum=0 i
    for ((i = step_number; i < step_count; ++i)); do sum=$((sum + expected[i])); done
    scaled_s "$sum"
}

# What the running step has left, in seconds: by how much ninja said is done, else by what was expected.
left_by_count() { # log seconds_spent seconds_expected
    local count all
    read -r count all < <(tail -c 2000 "$1" | sed -nE 's/^\[([0-9]+)\/([0-9]+)\].*/\1 \2/p' | tail -n 1)
    if ((${count:-0} * 10 >= ${all:-1})); then echo $(($2 * (all - count) / count)); else echo $(($3 > $2 ? $3 - $2 : 0)); fi
}
step_left_s=left_by_count

# A line that moves on a terminal, and a line now and then elsewhere.
show_progress() {
    local title=$1 log=$2 begun=$3 line spent left
    while sleep 1; do
        spent=$((SECONDS - begun))
        [[ -t 1 ]] || ((spent % 20 == 0)) || continue
        left=$(($(remaining_s) + $("$step_left_s" "$log" "$spent" "$(scaled_s "${expected[step_number - 1]}")")))
        line=$(tail -c 400 "$log" 2> /dev/null | tr '\r' '\n' | tail -n 1 | tr -cd '[:print:]')
        line="[$step_number/$step_count] $title, $(duration_text $((SECONDS - started))), about $(duration_text $left) left: $line"
        if [[ -t 1 ]]; then printf '\r\033[K%s' "${line:0:$(($(tput cols 2> /dev/null || echo 100) - 1))}"; else echo "$line"; fi
    done
}

stop_monitor() {
    [[ -z $monitor ]] && return
    kill "$monitor" 2> /dev/null
    wait "$monitor" 2> /dev/null
    monitor=
    [[ -t 1 ]] && printf '\r\033[K'
    return 0
}

# step TITLE LOG COMMAND …: runs the command, its output in build/log/LOG.txt; returns the command's exit code.
# With the last line of what a successful command said, where that is worth reading: step_note=yes.
step_note=no
step() {
    local title=$1 log=$logs/$2.txt begun=$SECONDS code=0
    shift 2
    step_number=$((step_number + 1))
    mkdir -p "$logs"
    : > "$log"
    show_progress "$title" "$log" "$begun" &
    monitor=$!
    "$@" > "$log" 2>&1 || code=$?
    stop_monitor
    if ((code == 0 && expected[step_number - 1] >= 10)); then
        done_expected=$((done_expected + expected[step_number - 1]))
        done_spent=$((done_spent + SECONDS - begun))
    fi
    local note=
    [[ $step_note == yes ]] && note=" ($(tail -n 1 "$log"))"
    ((code == 0)) && echo "[$step_number/$step_count] $title: done in $(duration_text $((SECONDS - begun)))$note"
    return "$code"
}

# The same for a step that must succeed.
must() {
    local title=$1 log=$logs/$2.txt code=0
    step "$@" || code=$?
    ((code == 0)) && return
    shift 2
    explain_failure "$title" "$log" "$code" "$*"
}

explain_failure() { # title log code command
    tail -n 20 "$2" | sed 's/^/    /' >&2
    fail "$1 failed (exit code $3). Everything it said: $2. The command: $4"
}

skip_step() {
    step_number=$((step_number + 1))
    echo "[$step_number/$step_count] $*"
}

interrupted() {
    stop_monitor
    echo "$(basename "$0"): stopped; run it again to go on" >&2
    exit 130
}
trap interrupted INT TERM

# ---- Packages
is_debian() { command -v apt-get > /dev/null && command -v dpkg-query > /dev/null; }

is_there() {
    local package=$1 kind=${2%%:*} what=${2#*:}
    if is_debian; then
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null) == installed ]]
        return
    fi
    case $kind in
        command) command -v "$what" > /dev/null ;;
        header) echo "#include <$what>" | g++ -std=c++20 -x c++ -fsyntax-only -I/usr/include - > /dev/null 2>&1 ;;
        file) [[ -e $what ]] ;;
        module) /usr/bin/python3 -c "import $what" > /dev/null 2>&1 ;;
    esac
}

missing_packages() {
    local entry package probe
    for entry in "${packages[@]}"; do
        read -r package probe <<< "$entry"
        is_there "$package" "$probe" || echo "$package"
    done
}

apt_install() {
    local sudo=()
    [[ $EUID -eq 0 ]] || sudo=(sudo)
    "${sudo[@]}" apt-get update &&
        "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@"
}

# Installs what is missing, or says how.
install_step() {
    local missing
    mapfile -t missing < <(missing_packages)
    if ((${#missing[@]} == 0)); then
        skip_step "packages: all ${#packages[@]} there"
        return
    fi
    is_debian || fail "this is not Debian or a relative of it. Missing, by their Debian names: ${missing[*]}"
    [[ $install == yes ]] || fail "missing: ${missing[*]}. Install them with: sudo apt-get install --no-install-recommends ${missing[*]}"
    if [[ $EUID -ne 0 ]]; then
        command -v sudo > /dev/null || fail "missing: ${missing[*]}. Run as root: apt-get install --no-install-recommends ${missing[*]}"
        sudo -v || fail "no right to install packages; with --no-install nothing is installed"
    fi
    must "packages: installing ${#missing[@]}" packages apt_install "${missing[@]}"
}

# ---- Build and scenes
build_target() { cmake --preset release && cmake --build "$build" --target "$1"; }

build_step() { must "build" build build_target "$1"; } # target

scenes_step() { must "scenes" scenes ./experiments/prepare_scenes; }

# How long these take: packages from nothing, and a build of SECONDS from nothing.
expected_install_s() { (($(missing_packages | wc -l) > 0)) && echo 270 || echo 0; }
expected_build_s() { [[ -x $build/bin/ssrlab ]] && echo 5 || echo "$1"; }
expected_scenes_s() { [[ -d ${SSRLAB_DATA:-scene_data}/sweethome3d ]] && echo 1 || echo 30; }
