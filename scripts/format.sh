#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Formats every C++ file of the project in place, or the files named: scripts/format.sh [FILE...]
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

if [ $# -gt 0 ]; then
    clang-format-19 -i --style=file "$@"
else
    our_sources | xargs -0 clang-format-19 -i --style=file
fi
