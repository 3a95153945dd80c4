#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Error of poses that obstacle-replay made of the scans (OUTPUT/matched_poses.csv) against true ones.

    scripts/pose_error.py TRUTH_ego.csv OUTPUT/matched_poses.csv

Both files: scan_index, timestamp, x, y, z, roll, pitch, yaw (world <- vehicle; metres, radians). Prints the error from
scan to scan, per second, and the error after 10, 50 and 100 m of the way, in per cent of it, seen from above. Poses of
different frames (column `frame`) are not compared with each other.
"""
import csv
import math
import sys


def read(name):
    with open(name, newline="") as file:
        rows = {}
        for r in csv.DictReader(file):
            rows[int(r["scan_index"])] = tuple(float(r[k]) for k in ("timestamp", "x", "y", "yaw")) + (r.get("frame"),)
        return rows


def step(a, b):
    """The way from pose a to b as a sees it: x, y, turn."""
    dx, dy = b[1] - a[1], b[2] - a[2]
    c, s = math.cos(a[3]), math.sin(a[3])
    return c * dx + s * dy, c * dy - s * dx, math.remainder(b[3] - a[3], 2 * math.pi)


def error(truth, ours, i, j):
    t, o = step(truth[i], truth[j]), step(ours[i], ours[j])
    return math.hypot(t[0] - o[0], t[1] - o[1]), abs(math.degrees(math.remainder(t[2] - o[2], 2 * math.pi)))


def quantiles(values):
    v = sorted(values)
    return "median %.3f, p95 %.3f, max %.3f" % (v[len(v) // 2], v[int(0.95 * (len(v) - 1))], v[-1]) if v else "none"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    truth, ours = read(sys.argv[1]), read(sys.argv[2])
    scans = sorted(set(truth) & set(ours))
    pairs = [(i, j) for i, j in zip(scans, scans[1:]) if ours[i][4] == ours[j][4]]
    print("poses: %d of %d scans, in %d frames" % (len(scans), len(truth), len({ours[i][4] for i in scans})))
    seconds = {p: truth[p[1]][0] - truth[p[0]][0] for p in pairs}
    errors = {p: error(truth, ours, *p) for p in pairs}
    print("speed error [m/s]: " + quantiles([errors[p][0] / seconds[p] for p in pairs]))
    print("turn error [deg/s]: " + quantiles([errors[p][1] / seconds[p] for p in pairs]))
    for length in (10, 50, 100):
        shares, turns = [], []
        for k in range(0, len(scans), 5):
            way, at = 0.0, k
            while way < length and at + 1 < len(scans) and ours[scans[at + 1]][4] == ours[scans[k]][4]:
                way += math.hypot(*step(truth[scans[at]], truth[scans[at + 1]])[:2])
                at += 1
            if way < length:
                continue
            place, turn = error(truth, ours, scans[k], scans[at])
            shares.append(100 * place / way)
            turns.append(turn / way)
        if shares:
            print("over %d m: %d stretches, place [%% of the way]: mean %.2f, %s; turn [deg/m]: mean %.4f"
                  % (length, len(shares), sum(shares) / len(shares), quantiles(shares), sum(turns) / len(turns)))


if __name__ == "__main__":
    main()
