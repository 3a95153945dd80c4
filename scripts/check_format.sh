#!/usr/bin/env bash
# Fails and names the places where a C++ file is not formatted as .clang-format says; scripts/format.sh mends them.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

our_sources | xargs -0 clang-format-19 --dry-run --Werror --style=file || die "run scripts/format.sh"
