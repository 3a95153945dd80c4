#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The truth of a simulated set at the instants for which boxes of `[tracking] stamp = now` hold.

    truth_now.py GT.csv EGO.csv OBSTACLES.csv OUTPUT_gt.csv

Each scan's instant is its timestamp + time_offset in OBSTACLES.csv. Objects are moved on from the timestamp by their
velocity and turning rate, the vehicle from its poses at the timestamp and in the middle of the scan. In OUTPUT the plain
columns x, y, z, yaw, vx, vy hold that pose in the vehicle frame of that instant: --gt-pose ref. Scans without a box
that was seen are left out.
"""
import csv
import math
import sys

import numpy as np


def rotation(roll, pitch, yaw):
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return (np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
            @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))


def offsets_of(file):
    """seconds after the timestamp of each scan, the median over its boxes."""
    found = {}
    for row in csv.DictReader(open(file)):
        if row['time_offset'] and row['class'] != 'structure':
            found.setdefault(int(row['scan_index']), []).append(float(row['time_offset']))
    return {scan: float(np.median(v)) for scan, v in found.items()}


def ego_at(row, after):
    """rotation and position of the vehicle so long after its timestamp."""
    share = after / (float(row['t_mid']) - float(row['timestamp']))

    def value(name, turns=False):
        step = float(row[name + '_mid']) - float(row[name])
        if turns: step = (step + math.pi) % (2 * math.pi) - math.pi
        return float(row[name]) + share * step
    return (rotation(value('roll', True), value('pitch', True), value('yaw', True)),
            np.array([value('x'), value('y'), value('z')]))


def main(gt, ego, obstacles, output):
    offsets = offsets_of(obstacles)
    poses = {int(row['scan_index']): row for row in csv.DictReader(open(ego))}
    rows = csv.DictReader(open(gt))
    names = ['timestamp', 'scan_index', 'object_id', 'type', 'x', 'y', 'z', 'length', 'width', 'height', 'yaw', 'vx', 'vy',
             'num_points', 'occluded']
    with open(output, 'w', newline='') as out:
        writer = csv.DictWriter(out, names, extrasaction='ignore')
        writer.writeheader()
        for row in rows:
            scan = int(row['scan_index'])
            if scan not in offsets: continue
            after = offsets[scan]
            R0, _ = ego_at(poses[scan], 0.0)
            R, t = ego_at(poses[scan], after)
            velocity = R0 @ np.array([float(row['vx']), float(row['vy']), 0.0])
            turn = float(row['yaw_rate']) * after
            half = rotation(0, 0, .5 * turn)  # a chord of the bend
            at = np.array([float(row[k + '_w']) for k in 'xyz']) + half @ velocity * after
            here, v = R.T @ (at - t), R.T @ rotation(0, 0, turn) @ velocity
            yaw = float(row['yaw_w']) + turn - math.atan2(R[1, 0], R[0, 0])
            row.update({'x': '%.4f' % here[0], 'y': '%.4f' % here[1], 'z': '%.4f' % here[2], 'vx': '%.3f' % v[0],
                        'vy': '%.3f' % v[1], 'yaw': '%.5f' % ((yaw + math.pi) % (2 * math.pi) - math.pi)})
            writer.writerow(row)


if __name__ == '__main__':
    if len(sys.argv) != 5: sys.exit(__doc__)
    main(*sys.argv[1:])
