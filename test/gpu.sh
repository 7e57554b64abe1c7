#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The everyday tests on an NVIDIA GPU, built in build-cuda/ with the Trilinos that RPC_TRILINOS_CUDA names (cmake/trilinos.sh
# --backend=cuda makes one):
#
#   bash test/gpu.sh [options of ctest]                       on a machine with GPUs: builds, and tests on one and two ranks. Where
#                                                             there are two GPUs, a rank has one of its own
#   bash test/gpu.sh --pack=FILE.tar.xz                       elsewhere: builds, and packs the programs and the libraries they need
#   bash test/gpu.sh --unpack=FILE.tar.xz [options of ctest]  with a GPU, but without compilers and libraries: tests what was packed,
#                                                             from a checkout of the same sources
#   --sanitizer=memcheck | racecheck                          the unit tests under NVIDIA's compute-sanitizer (ctest's -R chooses)
#
# Exit code 77, and the reason, where there is no GPU.
set -euo pipefail
RPC_PRESET=cuda
source "$(dirname "${BASH_SOURCE[0]}")/../cmake/setup.sh"

pack= unpack= sanitizer= skipped= options=()
for argument in "$@"; do
  case $argument in
  --pack=*) pack=${argument#*=} ;;
  --unpack=*) unpack=${argument#*=} ;;
  --sanitizer=memcheck | --sanitizer=racecheck) sanitizer=${argument#*=} ;;
  --sanitizer=*)
    say "--sanitizer must be memcheck or racecheck, got ${argument#*=}"
    exit 2
    ;;
  *) options+=("$argument") ;;
  esac
done

build_cuda() {
  if [ -z "${RPC_TRILINOS_CUDA:-}" ]; then
    say "RPC_TRILINOS_CUDA must name a Trilinos with CUDA; bash cmake/trilinos.sh --backend=cuda --prefix=DIR makes one"
    exit 2
  fi
  set_up
}

# Libraries that programs load, except the C library's own, which belong to the system that they run on.
libraries_of() {
  ldd "$@" | awk '$3 ~ /^\// {print $3}' | grep -Ev '/(libc|libm|libdl|librt|libpthread|libresolv)\.so' | sort -u
}

# Beside what git has: the programs without symbols, CTest's lists, and the libraries.
pack_tests() {
  local folder programs=("$build/rpc" "$build/rpc_tests" "$build/librpc_yield.so")
  if [ -e "$build/packages/mesh/rpc_gmsh" ]; then programs+=("$build/packages/mesh/rpc_gmsh"); fi
  folder=$(mktemp -d)
  mkdir -p "$folder/build-cuda/libraries"
  (cd "$root" && find build-cuda -name CTestTestfile.cmake -exec cp --parents {} "$folder" \;)
  for program in "${programs[@]}"; do
    (cd "$root" && cp --parents "${program#"$root"/}" "$folder")
    strip "$folder/${program#"$root"/}"
  done
  libraries_of "${programs[@]}" | xargs -r cp -L -t "$folder/build-cuda/libraries"
  echo "$root" >"$folder/build-cuda/source_dir"
  # The programs have most of their code in common and lie side by side: a dictionary that reaches from one to the other halves the archive.
  XZ_OPT=--lzma2=preset=2,dict=256MiB tar -C "$folder" --sort=name -cJf "$pack" build-cuda
  rm -rf "$folder"
  say "packed $(du -h "$pack" | cut -f1) in $pack"
}

# The lists and the tests name files by the path that the sources had where they were built.
unpack_tests() {
  tar -C "$root" -xJf "$unpack"
  local source_dir
  source_dir=$(cat "$build/source_dir")
  if [ ! "$source_dir" -ef "$root" ]; then
    if ! { mkdir -p "$(dirname "$source_dir")" && ln -sn "$root" "$source_dir"; }; then
      say "the tests were built in $source_dir: that path must lead to this checkout"
      exit 2
    fi
  fi
  cd "$source_dir/build-cuda"
  for tool in python3 cmake; do
    find . -name CTestTestfile.cmake -exec sed -i "s#\"/[^\"]*/$tool[.0-9]*\"#\"$(command -v $tool)\"#g" {} +
  done
  export LD_LIBRARY_PATH=$PWD/libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  say "install and configure tests SKIPPED: they take compilers and libraries"
  skipped='^(install|configure)\.|'
}

if [ -n "$pack" ]; then
  build_cuda
  pack_tests
  exit
fi
if ! nvidia-smi -L >/dev/null 2>&1; then
  say "GPU tests SKIPPED: nvidia-smi finds no GPU here"
  exit 77
fi
# Each rank takes the GPU of its number among these; Kokkos does that for the tests, rpc itself for its runs.
export KOKKOS_NUM_DEVICES=${KOKKOS_NUM_DEVICES:-$(nvidia-smi -L | wc -l)}
if [ -n "$unpack" ]; then
  unpack_tests
else
  build_cuda
  cd "$build"
fi
say "testing on $KOKKOS_NUM_DEVICES x $(nvidia-smi --query-gpu=name --format=csv,noheader | head -1)"
options+=(-E "$skipped"'\.np([3-9]|[1-9][0-9])$')
jobs=$(($(nproc) < 8 ? $(nproc) : 8)) # each takes half a gigabyte of the GPU
if [ -z "$sanitizer" ]; then
  exec ctest --output-on-failure --no-tests=error --parallel "$jobs" -LE 'performance|stress' "${options[@]}"
fi
exec python3 -B "$root/test/support/sanitize.py" --tool="$sanitizer" --jobs="$jobs" -- -L unit "${options[@]}"
