"""What the tests share: the vehicle, and numpy or not. Imported before fathom."""
import os
import queue
import subprocess
import sys
import threading
import time
import unittest

DOMAIN = 226
PATIENCE_S = 60.0  # what counts as never
SOURCE = os.environ["FATHOM_TEST_SOURCE"]
WITH_NUMPY = os.environ["FATHOM_TEST_NUMPY"] == "with"
if not WITH_NUMPY:
    sys.modules["numpy"] = None  # import numpy raises ImportError


class Vehicle:
    """vehicle.cpp, running."""

    def __init__(self):
        self._process = subprocess.Popen([os.environ["FATHOM_TEST_VEHICLE"], str(DOMAIN), f"{SOURCE}/deploy/dds"],
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.routes = queue.Queue()
        self.told = queue.Queue()  # orders and positions
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            words = line.split()
            (self.routes if words[0] == "route" else self.told).put(words)

    def say(self, line):
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()

    def end(self):
        self._process.stdin.close()
        assert self._process.wait(PATIENCE_S) == 0
        self._reader.join()
        self._process.stdout.close()


class WithVehicle(unittest.TestCase):
    """Tests beside a vehicle that tells its states."""

    @classmethod
    def setUpClass(cls):
        cls.vehicle = Vehicle()
        cls.vehicle.say("states on")

    @classmethod
    def tearDownClass(cls):
        cls.vehicle.end()


def wait_until(condition):
    end = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True
