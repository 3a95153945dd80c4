#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""live_client.py ADDRESS:PORT|PATH PART..: prints a line per scan of obstacle-live --serve. Parts: docs/live.md."""
import json
import socket
import sys

place, parts = sys.argv[1], sys.argv[2:] or ["tracks"]
if "/" in place:
    connection = socket.socket(socket.AF_UNIX)
    connection.connect(place)
else:
    connection = socket.create_connection(place.rsplit(":", 1))
connection.sendall(json.dumps({"subscribe": parts}).encode() + b"\n")
for line in connection.makefile():
    scan = json.loads(line)
    if "error" in scan:
        sys.exit(scan["error"])
    if set(parts) <= set(scan):
        print(scan["timestamp"], *(f"{part}: {len(scan[part])}" for part in parts), flush=True)
