#!/bin/sh
# Two builds of `walls_a_second` in turns: against.sh OLD NEW TURNS. Medians of processor time a run, their ratio, and
# whether all responses are the same to the bit.
set -eu
export LC_ALL=C
old=$1 new=$2 turns=$3
lines=$(mktemp)
trap 'rm -f "$lines" "$lines.of"' EXIT
turn=0
while [ "$turn" -lt "$turns" ]; do
    for which in old new; do
        if [ "$which" = old ]; then program=$old; else program=$new; fi
        "$program" > "$lines.of"
        sed "s/^/$which,/" "$lines.of" >> "$lines"
    done
    turn=$((turn + 1))
done
# Fields: which, kind, way, runs, seconds, evaluations, fingerprint.
sort -t, -k2,3 -k1,1 -k5,5n "$lines" | awk -F, '
    function tell() {
        printf "%-22s %-7s %9.3f %9.3f %8.2f   %s\n", kind, way, median["old"] * 1e3, median["new"] * 1e3,
            median["old"] / median["new"], same ? "same bits" : "OTHER BITS"
    }
    BEGIN { printf "%-22s %-7s %9s %9s %8s\n", "", "", "old, ms", "new, ms", "old/new" }
    $2 != kind || $3 != way {
        if (NR > 1) tell()
        kind = $2; way = $3; fingerprint = $7; same = 1; count["old"] = count["new"] = 0
    }
    {
        seconds[$1, ++count[$1]] = $5 / $4
        median[$1] = seconds[$1, int((count[$1] + 1) / 2)]
        if ($7 != fingerprint) same = 0
    }
    END { tell() }'
