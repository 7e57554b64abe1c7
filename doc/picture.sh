#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a picture of a result: bash doc/picture.sh RESULT [--output=FILE.png|.pdf|.svg] [options]
# RESULT: RESULT.e, a body; or RESULT.contact.csv, RESULT.history.csv, RESULT.points.csv, RESULT.json, one or several. doc/pictures.md has examples, --help all
# options. Installs Matplotlib and a reader of NetCDF where they are missing; takes neither a display nor a GPU.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bash "$here/../cmake/install_packages.sh" "$here/packages.txt"
exec /usr/bin/python3 -B "$here/picture/command_line.py" "$@" # Debian's Python, which sees Debian's modules
