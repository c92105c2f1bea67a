#!/bin/sh
# Two builds of `walls_a_second` in turns: against.sh OLD NEW TURNS. Medians of processor time a run, the ratio of each
# turn's median, and whether the responses are the same to the bit.
set -eu
export LC_ALL=C
old=$1 new=$2 turns=$3
i=0
while [ "$i" -lt "$turns" ]; do
    "$old" | sed 's/^/old,/'
    "$new" | sed 's/^/new,/'
    i=$((i + 1))
done | sort -t, -k2,3 -k1,1 -k5,5n | awk -F, '
    function told() {
        printf "%-22s %-7s %9.3f %9.3f %8.2f   %s\n", kind, way, median["old"] * 1e3, median["new"] * 1e3,
            median["old"] / median["new"], same ? "same bits" : "OTHER BITS"
    }
    BEGIN { printf "%-22s %-7s %9s %9s %8s\n", "", "", "old, ms", "new, ms", "old/new" }
    $2 "," $3 != case_ { if (case_ != "") told(); case_ = $2 "," $3; kind = $2; way = $3; same = 1; print_ = $7; split("", count) }
    { count[$1]++; seconds[$1, count[$1]] = $5 / $4; median[$1] = seconds[$1, int((count[$1] + 1) / 2)]
      if ($7 != print_) same = 0 }
    END { told() }'
