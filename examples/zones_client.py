#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the lines of obstacle-live --zones FILE --serve ADDRESS:PORT and says when a zone changes.

zones_client.py ADDRESS PORT [PATIENCE]: silence of more than PATIENCE seconds (1) counts as unknown.
"""
import json
import socket
import sys

states = {}


def tell(name, state, reason=""):
    if states.get(name) != state:
        states[name] = state
        print(f"{name}: {state} {reason}".strip(), flush=True)


connection = socket.create_connection((sys.argv[1], int(sys.argv[2])), float(sys.argv[3]) if len(sys.argv) > 3 else 1.0)
try:
    for line in connection.makefile():
        for zone in json.loads(line)["zones"]:
            tell(zone["name"], zone["state"], zone["reason"])
except TimeoutError:
    pass
for name in list(states):
    tell(name, "unknown", "connection lost")
