#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a PNG of a result: bash doc/picture.sh RESULT.e [--field=NAME] [--scale=FACTOR] [--cut=x=0] [--output=FILE.png]
# --help names all options. Installs Matplotlib and a reader of NetCDF where they are missing; takes neither a display nor a GPU.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bash "$here/../cmake/install_packages.sh" "$here/packages.txt"
exec /usr/bin/python3 -B "$here/picture/command_line.py" "$@" # Debian's Python, which sees Debian's modules
