#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the reference of the public headers in output/reference/html. A docstring that names what is not there is an error.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

install_packages reference
mkdir -p output/reference
doxygen docs/Doxyfile || die "the docstrings have mistakes, see above"
say "Written: output/reference/html/index.html"
