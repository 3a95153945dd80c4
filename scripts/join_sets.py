#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Joins the random scenes of scripts/accuracy.sh into one set: their truth and boxes one after the other in time.

    join_sets.py WORK RINGS OUTPUT      reads WORK/random_*_gt.csv and WORK/random_*_RINGS/obstacles.csv
"""
import csv
import glob
import re
import sys

APART = 100.0  # between two scenes [s]
IDS = 100000   # of each scene


def shifted(rows, scene, id_name):
    for row in rows:
        for name in row:
            if name.startswith('timestamp') or name in ('t_mid', 't_obs'):
                row[name] = '%.6f' % (float(row[name]) + APART * scene) if row[name] else row[name]
        row[id_name] = str(int(row[id_name]) + IDS * scene)
        yield row


def join(files, target, id_name):
    writer = None
    with open(target, 'w', newline='') as out:
        for scene, file in enumerate(files):
            with open(file, newline='') as f:
                reader = csv.DictReader(f)
                writer = writer or csv.DictWriter(out, reader.fieldnames)
                if scene == 0:
                    writer.writeheader()
                writer.writerows(shifted(reader, scene, id_name))


def main():
    work, rings, output = sys.argv[1:]
    truth = sorted(f for f in glob.glob(work + '/random_*_gt.csv') if re.search(r'random_\d+_gt\.csv$', f))
    join(truth, output + '/gt.csv', 'object_id')
    join([f[:-len('_gt.csv')] + '_' + rings + '/obstacles.csv' for f in truth], output + '/obstacles.csv', 'id')


main()
