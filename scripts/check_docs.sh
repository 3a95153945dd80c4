#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fails where a document links to a file that is not there, names a heading, parameter, option or key that does not exist
# (check_docs.py), the README has 900 words or more, or figures of it or of docs/limits.md are not those of BENCHMARK.md.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

broken=0
while IFS= read -r document; do
    folder=$(dirname "$document")
    while IFS= read -r link; do
        [ -e "$folder/${link%%#*}" ] && continue
        printf '%s: no such file: %s\n' "$document" "$link" >&2
        broken=1
    done < <(grep -oE '\]\([^)#: ]+(#[^)]*)?\)' "$document" | sed -E 's/^\]\(//; s/\)$//')
done < <(find . -name '*.md' -not -path './build/*' -not -path './output/*')

# headline NAME SET BOXES: the row of the README's table that BENCHMARK.md gives, up to the figures of others.
headline() {
    awk -F ' *[|] *' -v name="$1" -v set="$2" -v boxes="$3" '
        $2 == set && $3 == 16 && $4 ~ "/" && NF == 11 { gsub(/[*]/, ""); f1 = $5; people = $8; near = $10; sub(/ [(].*/, "", near) }
        $2 == boxes && $3 == 16 { split($9, overlap, " "); iou[$4] = overlap[1] }
        END { printf "| %s | %s | %s | %s | **%s** / %s /", name, f1, people, near, iou["auto"], iou["paper"] }' BENCHMARK.md
}
for row in "$(headline 'KITTI drive 0001' kitti_0001 kitti_0001_16)" "$(headline 'simulated street' sim_street sim_street)"; do
    grep -qF -- "$row" README.md && continue
    printf 'README.md: its table does not have what BENCHMARK.md says: %s\n' "$row" >&2
    broken=1
done

# The lowest and the highest recall of vehicles by 4 rings.
found=$(awk -F ' *[|] *' '$3 == 4 && $4 ~ "/" && NF == 11 { split($4, v, " / "); print v[2] }' BENCHMARK.md | sort -n |
    sed 's/^0//' | sed -n '1h; ${ H; x; s/\n/ to /p }')
for document in README.md docs/limits.md; do
    grep -qF -- "by 4 rings $found of the vehicles" $document && continue
    printf '%s: does not say what BENCHMARK.md says: by 4 rings %s of the vehicles are found\n' $document "$found" >&2
    broken=1
done

/usr/bin/python3 scripts/check_docs.py || broken=1
words=$(wc -w <README.md)
[ "$words" -lt 900 ] || { printf 'README.md: %s words; 900 are too many\n' "$words" >&2 && broken=1; }
[ $broken -eq 0 ] || die "the documents need mending, see above"
