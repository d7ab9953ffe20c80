"""Whether navigation is as quick as ever while the recorder's disk, or whoever reads the logs, is in trouble.

In one run trouble comes and goes. Compared are the latencies of the navigation states, from the arrival of an inertial sample
at its bridge to a reader of the state, with trouble and without it.
"""
import fcntl
import os
import signal
import subprocess
import time

from vehicle import ROOT, Vehicle

PHASE_S = 10.0
SETTLE_S = 2.0  # after a change, not counted
LIMIT = 1.05    # of the 99th percentile


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


class Full:
    """A disk of 24 MB that something else fills up."""
    def __init__(self, vehicle):
        self.ballast = os.path.join(vehicle.recordings, "ballast")

    @staticmethod
    def prepare(vehicle):
        mount(vehicle.recordings)

    def begin(self):
        try:
            with open(self.ballast, "wb") as file:
                while True:
                    file.write(bytes(1 << 16))
                    file.flush()
        except OSError:
            pass

    def end(self):
        os.remove(self.ballast)


class ReadOnly:
    """A disk that can only be read when the recorder starts."""
    def __init__(self, vehicle):
        self.vehicle = vehicle

    @staticmethod
    def prepare(vehicle):
        mount(vehicle.recordings)

    def begin(self):
        self.vehicle.kill("recorder", signal.SIGTERM)
        subprocess.run(["mount", "-o", "remount,ro", self.vehicle.recordings], check=True)
        self.vehicle.start("recorder", wait_s=0.0)

    def end(self):
        subprocess.run(["mount", "-o", "remount,rw", self.vehicle.recordings], check=True)


class Slow:
    """A disk of 1 MB/s, 50 ms a sync."""
    def __init__(self, vehicle):
        self.mark = vehicle.path("slow")

    @staticmethod
    def prepare(vehicle):
        library = vehicle.path("slow_disk.so")
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library,
                        os.path.join(ROOT, "tests/soak/black_box/slow_disk.c"), "-ldl"], check=True)
        vehicle.service_environment = {"LD_PRELOAD": library, "FATHOM_SLOW_DISK": vehicle.path("slow")}

    def begin(self):
        open(self.mark, "w", encoding="utf-8").close()

    def end(self):
        os.remove(self.mark)


class Pipes:
    """Whatever the services say goes into a pipe of 64 kB, which is full, and nobody reads it."""
    def __init__(self, vehicle):
        self.reading, self.writing = vehicle.pipe

    @staticmethod
    def prepare(vehicle):
        vehicle.pipe = os.pipe()
        fcntl.fcntl(vehicle.pipe[0], fcntl.F_SETFL, os.O_NONBLOCK)

    def drain(self):
        try:
            while os.read(self.reading, 1 << 16):
                pass
        except BlockingIOError:
            pass

    def begin(self):
        # Another description of it, so that the services' own goes on blocking.
        writing = os.open(f"/proc/self/fd/{self.writing}", os.O_WRONLY | os.O_NONBLOCK)
        try:
            for size in (4096, 1):
                try:
                    while True:
                        os.write(writing, b"\n" * size)
                except BlockingIOError:
                    pass
        finally:
            os.close(writing)

    def end(self):
        self.drain()


TROUBLES = {"full": Full, "read_only": ReadOnly, "slow": Slow, "pipes": Pipes}


def mount(folder):
    os.makedirs(folder, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=24m", "fathom-soak", folder], check=True)


def trouble(name, build, domain, seconds):
    """(held, figures): in phases of trouble and of quiet, one after the other."""
    with Vehicle(build, domain) as vehicle:
        kind = TROUBLES[name]
        kind.prepare(vehicle)
        latencies = vehicle.path("latencies.txt")
        watch = None
        try:
            vehicle.start(out=vehicle.pipe[1] if name == "pipes" else None)
            watch = subprocess.Popen([os.path.join(build, "tests/soak_nav_watch"), "--domain", str(domain), "--latencies",
                                      latencies], stdout=subprocess.DEVNULL, env=vehicle.environment)
            one = kind(vehicle)
            time.sleep(8.0)
            phases = []
            for k in range(max(2, int(seconds / PHASE_S))):
                if k % 2 == 1:
                    one.begin()
                elif k > 0:
                    one.end()
                begin = time.monotonic() + SETTLE_S
                while time.monotonic() < begin - SETTLE_S + PHASE_S:
                    if name == "pipes" and k % 2 == 0:
                        one.drain()
                    time.sleep(0.05)
                phases.append((k % 2 == 1, begin, time.monotonic()))
            if len(phases) % 2 == 0:
                one.end()
            watch.terminate()
            watch.wait(timeout=30)
            vehicle.stop()
            said = [line for line in vehicle.log("recorder").splitlines() if "lost" in line or "dropped" in line]
            verdicts = [vehicle.fathom("record", "--recover", file) for file in vehicle.files()]
            with open(latencies, encoding="utf-8") as text:
                rows = [tuple(map(float, line.split())) for line in text if line.count(" ") == 1 and line.endswith("\n")]
        finally:
            if watch:
                watch.kill()
            for service in list(vehicle.running):
                vehicle.kill(service)
            if os.path.ismount(vehicle.recordings):
                subprocess.run(["umount", vehicle.recordings], check=False)
    values = {on: [1e3 * row[1] for row in rows if any(a <= row[0] <= b for state, a, b in phases if state == on)]
              for on in (False, True)}
    if any(len(values[on]) < 500 for on in values):
        print(f"{name}: too few states: {len(values[False])} and {len(values[True])}")
        return False, {}
    figures = {f"{name}_{word}_p{int(100 * share)}_ms": quantile(values[on], share)
               for on, word in ((False, "quiet"), (True, "trouble")) for share in (0.5, 0.99)}
    ratio = figures[f"{name}_trouble_p99_ms"] / figures[f"{name}_quiet_p99_ms"]
    figures[f"{name}_p99_ratio"] = ratio
    readable = all(code == 0 for code, _ in verdicts) and bool(verdicts)
    print(f"{name}: {len(values[False])} and {len(values[True])} states; p50 {figures[name + '_quiet_p50_ms']:.3f} and "
          f"{figures[name + '_trouble_p50_ms']:.3f} ms, p99 {figures[name + '_quiet_p99_ms']:.3f} and "
          f"{figures[name + '_trouble_p99_ms']:.3f} ms: {ratio:.2f} times; "
          f"{len(verdicts)} files, {'all' if readable else 'NOT all'} whole")
    for line in said[-1:]:
        print(f"  recorder: {line}")
    return ratio <= LIMIT and readable, figures
