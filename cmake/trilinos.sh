#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the Trilinos that rpc takes for threads or for a GPU (Debian's own runs Kokkos Serial): --help says how.
# A run that was interrupted goes on where it stood. No step is marked as done: the source tree gets its name when it is whole and
# patched, CMake and Ninja know by themselves what is left, and the installation is made aside before it is copied to its place.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/cmake/common.sh"

usage() {
  cat <<'END'
bash cmake/trilinos.sh --backend=openmp|cuda --prefix=DIR [--source=DIR] [--build=DIR] [--jobs=N] [--arch=NAME]
                       [--without-mpi]

Builds Trilinos 13.2, static and with only what rpc needs, and installs it. The folder may be moved or copied afterwards.
  --backend=openmp  Kokkos OpenMP, with MPI
  --backend=cuda    Kokkos CUDA (Serial on the host), with MPI: a rank a GPU
  --prefix=DIR      where to install: a new folder, or what an earlier run left
  --source=DIR      a tree of Trilinos 13.2, which is copied; default: Debian's source package is downloaded
  --build=DIR       where to build; default: build-trilinos in the repository. Run the same command again to continue there.
  --jobs=N          default: one for each core that has 1.5 GB of memory
  --arch=NAME       cuda: sm_60, sm_61, sm_70, sm_72, sm_75, sm_80, sm_86, sm_90 or Kokkos' name (HOPPER90); default: sm_90.
                    openmp: a processor for -march; default: x86-64-v3 where this machine's is one, else the compiler's default
  --without-mpi     cuda: for one process on one GPU
END
}
stop() { say "$*"; exit 1; }
misused() { say "$*"; exit 2; }

# ------------------------------------------------------------------------------------------------------------------- options
backend='' prefix='' source='' build=$root/build-trilinos jobs=$(build_jobs) arch='' mpi=ON
for argument in "$@"; do
  value=${argument#*=}
  case $argument in
    --backend=openmp | --backend=cuda) backend=$value ;;
    --prefix=?*) prefix=$(realpath -ms -- "$value") ;;
    --source=?*) source=$(realpath -ms -- "$value") ;;
    --build=?*) build=$(realpath -ms -- "$value") ;;
    --jobs=*[!0-9]* | --jobs=0* | --jobs=) misused "--jobs must be a number from 1 on, got \"$value\"" ;;
    --jobs=*) jobs=$value ;;
    --arch=?*) arch=$value ;;
    --without-mpi) mpi=OFF ;;
    --help | -h) usage; exit ;;
    *) misused "unknown option \"$argument\"; bash cmake/trilinos.sh --help lists them" ;;
  esac
done
[ -n "$backend" ] || misused "which backend? --backend=openmp or --backend=cuda"
[ $mpi = ON ] || [ "$backend" = cuda ] || misused "--without-mpi goes with --backend=cuda"
[ -n "$prefix" ] || misused "where to install? --prefix=DIR"
case $prefix$build$source in
  *[!A-Za-z0-9_./+-]*) misused "folders must be named with letters, digits and _ . + - only: Trilinos' scripts split others" ;;
esac
case $build/ in "$prefix"/*) misused "--build must be outside --prefix" ;; esac
case $prefix/ in "$build"/*) misused "--prefix must be outside --build" ;; esac
if [ -n "$source" ]; then
  grep -qs 'Trilinos_VERSION 13\.2' "$source/Version.cmake" || misused "$source is not the source of Trilinos 13.2: Version.cmake does not say so"
  case $build/ in "$source"/*) misused "--build must be outside --source, which stays as it is" ;; esac
fi

# What the processor has to have: programs for x86-64-v3 (AVX2, FMA) run on any made since 2015.
march() {
  if [ "$backend" = openmp ] && [ -n "$arch" ]; then
    echo "-march=$arch"
  elif [ "$(uname -m)" = x86_64 ] && grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; then
    echo "-march=x86-64-v3"
  fi
}

if [ "$backend" = cuda ]; then
  known="PASCAL60 PASCAL61 VOLTA70 VOLTA72 TURING75 AMPERE80 AMPERE86 HOPPER90" # before Pascal, host and card cannot share memory
  gpu=
  for name in $known; do
    case ${arch:-sm_90} in "$name" | "${name,,}" | "sm_${name: -2}") gpu=$name ;; esac
  done
  [ -n "$gpu" ] || misused "--arch=$arch is none of sm_60, sm_61, sm_70, sm_72, sm_75, sm_80, sm_86, sm_90 or ${known// /, }"
  title="Kokkos CUDA for sm_${gpu: -2}, with$([ $mpi = ON ] || echo out) MPI" variable=RPC_TRILINOS_CUDA
  job_seconds=10600 build_mb=1500 install_mb=600
else
  title="Kokkos OpenMP with MPI" variable=RPC_TRILINOS_OPENMP
  job_seconds=5700 build_mb=800 install_mb=400
fi
# mpi_flags compile|link: what MPI's own compiler would add, Open MPI's or MPICH's
mpi_flags() {
  { mpicxx --showme:"$1" 2>/dev/null || mpicxx -"$1"-info 2>/dev/null | cut -d ' ' -f 2-; } | tr ' ' '\n' | grep -E '^-[ILl]|^-Wl,' | tr '\n' ' '
}
flags="-w $(march)" # 13.2 has warnings by the thousand; -march belongs to all build types
if [ "$backend$mpi" = cudaON ] && command -v mpicxx >/dev/null; then flags+=" $(mpi_flags compile)"; fi
note="$prefix/rpc_trilinos.txt"
if [ -n "$(ls -A "$prefix" 2>/dev/null)" ] && [ "$(head -n 1 "$note" 2>/dev/null)" != "Trilinos 13.2, $title" ]; then
  misused "$prefix holds something else than Trilinos for $title: remove it or name a new folder"
fi

# ---------------------------------------------------------------------------------------------------------------- tools, disk
nvcc=$(command -v nvcc || echo /usr/local/cuda/bin/nvcc)
missing=()
need() { command -v "$1" >/dev/null || missing+=("$2"); }
need g++ g++
need cmake cmake
need ninja ninja-build
need patch patch
need flock util-linux
if [ -z "$source" ]; then
  command -v apt-get >/dev/null || stop "no apt-get here to download Debian's source package: unpack Trilinos 13.2 and name it, --source=DIR"
  need dpkg-source dpkg-dev
  [ -e /usr/share/keyrings/debian-archive-keyring.gpg ] || missing+=(debian-archive-keyring)
fi
if [ $mpi = ON ]; then need mpicxx libopenmpi-dev; fi
for library in blas lapack; do
  echo 'int main() {}' | g++ -x c++ - -l$library -o /dev/null 2>/dev/null || missing+=(lib$library-dev)
done
[ ${#missing[@]} -eq 0 ] || stop "some tools are missing. On Debian: apt-get install ${missing[*]}"
if [ "$backend" = cuda ]; then
  [ -x "$nvcc" ] || stop "nvcc is neither in PATH nor in /usr/local/cuda/bin: install the CUDA toolkit (13.0 is what was tried)"
  "$nvcc" --list-gpu-arch | grep -qx "compute_${gpu: -2}" || stop "$nvcc does not know sm_${gpu: -2}: take another --arch or CUDA toolkit"
fi

source_mb=$([ -n "$source" ] && echo 830 || echo 1010) # the tree, the download
from=${source:-"Debian's source package, 166 MB to download"}
say "Trilinos 13.2, $title"
say "  from     $from; patches in cmake/patches"
say "  built in $build: up to $(((source_mb + build_mb + install_mb) / 100))00 MB, which may be removed afterwards"
say "  to       $prefix: $install_mb MB"
say "  time     about $((job_seconds / jobs / 60 + 3)) minutes with $jobs job(s) of an idle machine; repeated, an interrupted run goes on"

# existing <folder>: itself or the nearest folder above that exists
existing() {
  local dir=$1
  while [ ! -d "$dir" ]; do dir=$(dirname "$dir"); done
  echo "$dir"
}
# room_for <megabytes> <folder>: stops unless the folder can be written to and has room for what it does not hold yet
room_for() {
  local there free
  there=$(existing "$2")
  [ -w "$there" ] || stop "no permission to write to $there"
  free=$(($(df -Pm "$there" | awk 'END {print $4}')))
  if [ -d "$2" ]; then free=$((free + $(du -sm "$2" | cut -f 1))); fi
  [ $free -ge "$1" ] || stop "$there has $free MB of free disk, but $1 are needed: free some, or take another --build or --prefix"
}
on_disk() { df -P "$(existing "$1")" | awk 'END {print $6}'; }
room_for "$install_mb" "$prefix"
if [ "$(on_disk "$build")" = "$(on_disk "$prefix")" ]; then build_mb=$((build_mb + install_mb)); fi
room_for $((source_mb + build_mb + install_mb)) "$build" # the installation is made there first

mkdir -p "$build"
exec 9>"$build/lock"
flock -n 9 || stop "another run is building in $build"

# --------------------------------------------------------------------------------------------------------------------- source
tree=$build/trilinos-13.2
part=$build/unpacked/trilinos-13.2 # what happens to lie beside it goes with the folder

# Debian's source package, whose checksums apt and dpkg-source verify. apt gets a list and a state of its own: the system's may have
# no deb-src line, or another release with another Trilinos, and stay as they are; so no root is needed either.
download() (
  apt=$build/download
  options=(-q -o Dir::Etc::SourceList="$apt/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$apt/lists"
    -o Dir::Cache="$apt/cache" -o Acquire::Languages=none -o Acquire::Retries=3 -o APT::Sandbox::User="$(id -un)")
  keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial" &&
    echo "deb-src [signed-by=$keyring] http://deb.debian.org/debian bookworm main" >"$apt/sources.list" &&
    cd "$apt" && # apt-get and dpkg-source leave files where they run
    apt-get "${options[@]}" update &&
    apt-get "${options[@]}" --download-only source trilinos &&
    dpkg-source --no-copy -x trilinos_13.2.0-*.dsc "$part"
)

copy() {
  mkdir "$part"
  tar -C "$source" --exclude-vcs -cf - . | tar -C "$part" -xf -
}

# A patch that the tree has already is passed over.
apply_patches() {
  local patch options=(--directory="$part" --strip=1 --force --silent --no-backup-if-mismatch)
  for patch in "$root"/cmake/patches/*.patch; do
    if patch "${options[@]}" --reverse --fuzz=0 --dry-run <"$patch" >/dev/null 2>&1; then
      say "  $(basename "$patch"): already there"
    elif ! patch "${options[@]}" --forward <"$patch" >&2; then
      stop "$(basename "$patch") does not fit $from, which is not the Trilinos 13.2 that was released"
    fi
  done
}

origin=$(echo "${source:-Debian}"; cat "$root"/cmake/patches/*.patch | sha256sum)
if [ "$(cat "$tree/.rpc_origin" 2>/dev/null)" != "$origin" ]; then
  [ ! -e "$tree" ] || [ -e "$tree/.rpc_origin" ] || stop "$tree was not made by this script: take another --build"
  rm -rf "$build/unpacked"
  mkdir "$build/unpacked"
  if [ -n "$source" ]; then
    say "copying $source"
    copy
  else
    say "downloading and unpacking"
    quietly "$build/download.log" download
  fi
  say "patching"
  apply_patches
  echo "$origin" >"$part/.rpc_origin"
  rm -rf "$tree"
  mv "$part" "$tree"
  rm -rf "$build/unpacked"
fi

# ------------------------------------------------------------------------------------------------------------------ configure
options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" -DBUILD_SHARED_LIBS=OFF -DCMAKE_CXX_STANDARD=17 -DCMAKE_CXX_EXTENSIONS=OFF
  -DCMAKE_C_FLAGS="$flags" -DCMAKE_CXX_FLAGS="$flags"
  -DTrilinos_ENABLE_{Fortran,TESTS,EXAMPLES,ALL_OPTIONAL_PACKAGES,SECONDARY_TESTED_CODE,FLOAT,COMPLEX,EXPORT_MAKEFILES}=OFF
  -DTrilinos_ENABLE_{EXPLICIT_INSTANTIATION,INSTALL_CMAKE_CONFIG_FILES}=ON
  # double, int, long long: one instantiation of each class
  -DTpetra_INST_{INT_INT,INT_UNSIGNED,INT_UNSIGNED_LONG,INT_LONG}=OFF -DTpetra_INST_INT_LONG_LONG=ON
  -DTrilinos_ENABLE_{Teuchos,TeuchosKokkosCompat,TeuchosKokkosComm,Kokkos,KokkosKernels,Tpetra,TpetraTSQR}=ON
  -DTrilinos_ENABLE_{Belos,Xpetra,Amesos2,Ifpack2,MueLu,NOX}=ON
  -DBelos_ENABLE_{Tpetra,Xpetra}=ON -DXpetra_ENABLE_{Tpetra,KokkosKernels}=ON -DAmesos2_ENABLE_KLU2=ON -DIfpack2_ENABLE_{Xpetra,Amesos2}=ON
  -DMueLu_ENABLE_{Tpetra,Belos,Ifpack2,Amesos2,Kokkos_Refactor}=ON -DNOX_ENABLE_{LOCA,ABSTRACT_IMPLEMENTATION_LAPACK}=OFF
  -DTPL_ENABLE_{BLAS,LAPACK}=ON)
if [ $mpi = ON ]; then # Zoltan2 lets MueLu gather coarse levels on fewer ranks; one rank has no use for it
  options+=(-DTPL_ENABLE_MPI=ON -DTrilinos_ENABLE_{Zoltan,Zoltan2,Zoltan2Core}=ON -DMueLu_ENABLE_{Zoltan,Zoltan2Core}=ON)
else
  options+=(-DTPL_ENABLE_MPI=OFF)
fi
if [ "$backend" = openmp ]; then
  options+=(-DCMAKE_C_COMPILER="$(command -v mpicc)" -DCMAKE_CXX_COMPILER="$(command -v mpicxx)"
    -DTrilinos_ENABLE_OpenMP=ON -DKokkos_ENABLE_OPENMP=ON -DKokkos_ENABLE_SERIAL=OFF -DTpetra_INST_OPENMP=ON -DTpetra_INST_SERIAL=OFF)
else
  CUDA_ROOT=$(dirname "$(dirname "$nvcc")")
  export CUDA_ROOT PATH="$CUDA_ROOT/bin:$PATH" # for nvcc_wrapper
  options+=(-DCMAKE_C_COMPILER="$(command -v gcc)" -DCMAKE_CXX_COMPILER="$tree/packages/kokkos/bin/nvcc_wrapper"
    -DTPL_ENABLE_CUDA=ON -DCUDA_TOOLKIT_ROOT_DIR="$CUDA_ROOT" -DTPL_ENABLE_{CUBLAS,CUSPARSE,CUSOLVER}=OFF
    -DKokkos_ENABLE_{CUDA,CUDA_LAMBDA,CUDA_UVM,SERIAL}=ON -DKokkos_ENABLE_CUDA_RELOCATABLE_DEVICE_CODE=OFF
    -DKokkosKernels_INST_MEMSPACE_CUDASPACE=OFF -DTpetra_INST_CUDA=ON -DTpetra_INST_{SERIAL,OPENMP}=OFF)
  if [ $mpi = ON ]; then # nvcc_wrapper itself compiles: programs need no settings of MPI's wrappers
    options+=(-DMPI_USE_COMPILER_WRAPPERS=OFF -DMPI_EXEC="$(command -v mpirun)" -DTrilinos_EXTRA_LINK_FLAGS="$(mpi_flags link)")
  fi
  for name in $known; do # another --arch than last time
    options+=(-DKokkos_ARCH_"$name"="$([ "$name" = "$gpu" ] && echo ON || echo OFF)")
  done
fi
objects=$build/$backend
mkdir -p "$objects"
say "configuring"
quietly "$objects/configure.log" cmake -S "$tree" -B "$objects" -G Ninja "${options[@]}"

# -------------------------------------------------------------------------------------------------------------- build, install
say "building with $jobs job(s), log: $objects/build.log"
building "$objects/build.log" cmake --build "$objects" --parallel "$jobs"

say "installing"
stage=$objects/stage
rm -rf "$stage"
quietly "$objects/install.log" env DESTDIR="$stage" cmake --install "$objects"
# lib/cmake/<package>/ names the prefix; from there on it names itself.
find "$stage$prefix/lib/cmake" -name '*.cmake' -exec sed -i "s|$prefix|\${CMAKE_CURRENT_LIST_DIR}/../../..|g" {} +
{
  echo "Trilinos 13.2, $title"
  echo "Built by cmake/trilinos.sh of rpc with the flags $flags and the patches"
  (cd "$root/cmake/patches" && ls -- *.patch)
} >"$stage$note"
mkdir -p "$prefix"
cp "$stage$note" "$prefix/" # first: it says whose folder this is, should the rest be interrupted
cp -a "$stage$prefix/." "$prefix/"
rm -rf "$stage"

say "done: $prefix, $(du -sm "$prefix" | cut -f 1) MB. $build may be removed. To build rpc with it:"
say "  export $variable=$prefix"
say "  cmake --preset $backend && cmake --build --preset $backend"
