"""Loads a volume with the installed Python module and checks it: volume.py FILE"""
import sys

import fcl_stpbv

volume = fcl_stpbv.StpBv.load(sys.argv[1])
found = volume.verify()
assert found, found.message
print(volume)
