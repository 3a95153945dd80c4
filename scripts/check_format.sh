#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fails and names the places where a C++ file is not formatted as .clang-format says (scripts/format.sh mends them), and
# files without the line of the licence (scripts/spdx.sh).
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

cd "$repo"
our_sources | xargs -0 clang-format-19 --dry-run --Werror --style=file || die "run scripts/format.sh"
scripts/spdx.sh --check
