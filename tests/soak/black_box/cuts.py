"""Whether every recording recovers that was cut off: by kill -9 of the recorder, and at any byte."""
import json
import os
import random
import re
import struct
import time

from vehicle import ROOT, Vehicle, wait_until

MAGIC = b"\x89MCAP0\r\n"
CHANNEL, CHUNK, MESSAGE_INDEX, STATISTICS = 0x04, 0x06, 0x07, 0x0B
LOST_AT_MOST_NS = 1_000_000_000
IMU_HZ = 400
# A recorder that lived so long has found the instruments (0.6 s), and a second of them is on the disk. One that was killed
# earlier may hold none of their samples; what it does hold must still reach to a second before its end.
FOUND_NS = 2_500_000_000


def records(data, at, end):
    """(opcode, content, offset behind it) of each record between two offsets, as the MCAP specification lays them out."""
    while at + 9 <= end:
        opcode, length = struct.unpack_from("<BQ", data, at)
        if at + 9 + length > end:
            return
        yield opcode, data[at + 9:at + 9 + length], at + 9 + length
        at += 9 + length


def summary(path):
    """(messages, log time of the last one in ns, messages by topic) as the summary of a closed file says; None: it has none."""
    with open(path, "rb") as file:
        data = file.read()
    if not data.startswith(MAGIC) or not data.endswith(MAGIC) or len(data) < 45:
        return None
    start, = struct.unpack_from("<Q", data, len(data) - 28)
    topics, out = {}, None
    for opcode, content, _ in records(data, start, len(data) - 37):
        if opcode == CHANNEL:
            channel, _, length = struct.unpack_from("<HHI", content)
            topics[channel] = content[8:8 + length].decode()
        if opcode == STATISTICS:
            messages, = struct.unpack_from("<Q", content)
            last_ns, size = struct.unpack_from("<QI", content, 34)
            counts = [struct.unpack_from("<HQ", content, 46 + 10 * i) for i in range(size // 10)]
            out = (messages, last_ns, counts)
    if out is None:
        return None
    by_topic = {}
    for channel, count in out[2]:
        by_topic[topics[channel]] = by_topic.get(topics[channel], 0) + count
    return out[0], out[1], by_topic


def chunks(data):
    """(offset behind a chunk and its indexes, messages up to there) of a whole file."""
    out, count = [], 0
    for opcode, content, behind in records(data, len(MAGIC), len(data) - len(MAGIC)):
        if opcode == MESSAGE_INDEX:
            count += struct.unpack_from("<I", content, 2)[0] // 16
        if opcode in (CHUNK, MESSAGE_INDEX):
            out.append((behind, count))
    return out


def at_full_rate(build, domain):
    """The survey with an inertial unit of 400 Hz."""
    vehicle = Vehicle(build, domain)
    with open(os.path.join(ROOT, "deploy/config/scenarios/survey.json"), encoding="utf-8") as text:
        changed = json.load(text)
    changed["sensors"]["imu"]["rate_hz"] = IMU_HZ
    file = vehicle.path("full_rate.json")
    with open(file, "w", encoding="utf-8") as text:
        json.dump(changed, text)
    words = vehicle.commands["simulator"]
    vehicle.commands["simulator"] = [f"scenario={file}" if word.startswith("scenario=") else word for word in words]
    vehicle.commands["fusion"] = vehicle.commands["fusion"] + ["--set", f"engine.imu.nominal_rate_hz={IMU_HZ}"]
    return vehicle


def kills(build, domain, options):
    """The recorder is killed at random instants. Every other file is closed by the command, the rest by the next start."""
    choose = random.Random(options.seed)
    worst_ns, bad = 0, []
    with at_full_rate(build, domain) as vehicle:
        vehicle.start()
        time.sleep(5.0)  # until the instruments speak
        killed_ns, lived_ns, started_ns = {}, {}, time.time_ns()
        for again in range(options.kills):
            known = set(vehicle.files())
            if again > 0:
                started_ns = time.time_ns()
                vehicle.start("recorder")
            if not wait_until(lambda: set(vehicle.files()) - set(killed_ns), 60):
                bad.append(f"kill {again}: no new file within 60 s")
                break
            time.sleep(choose.uniform(0.2, 4.0))
            now_ns = time.time_ns()
            vehicle.kill("recorder")
            for one in set(vehicle.files()) - set(killed_ns):
                killed_ns[one], lived_ns[one] = now_ns, now_ns - started_ns
                if again % 2 == 0:
                    code, said = vehicle.fathom("record", "--recover", one)
                    if code != 0:
                        bad.append(f"kill {again}: exit code {code}: {said}")
            assert set(vehicle.files()) >= known
        vehicle.start("recorder")
        time.sleep(3.0)
        vehicle.stop()
        for one, when_ns in killed_ns.items():
            found = summary(one)
            if found is None:
                bad.append(f"{os.path.basename(one)}: has no summary")
                continue
            worst_ns = max(worst_ns, when_ns - found[1])
            if when_ns - found[1] > LOST_AT_MOST_NS:
                bad.append(f"{os.path.basename(one)}: the last {(when_ns - found[1]) / 1e9:.2f} s are lost")
            if lived_ns[one] > FOUND_NS and found[2].get("fathom/v1/imu", 0) == 0:
                bad.append(f"{os.path.basename(one)}: no inertial sample is in its {found[0]} messages: {found[2]}")
    judged = sum(1 for lived in lived_ns.values() if lived > FOUND_NS)
    print(f"{len(killed_ns)} files of killed recorders: {'all recovered' if not bad else 'BAD'}, "
          f"at most {worst_ns / 1e9:.2f} s lost; {judged} of them must hold inertial samples")
    print("\n".join(bad[:20]), end="\n" if bad else "")
    good = not bad and len(killed_ns) == options.kills and judged > 0
    return good, {"kills": len(killed_ns), "kills_bad": len(bad), "kills_judged_by_samples": judged,
                  "kills_most_lost_s": worst_ns / 1e9}


def truncations(build, domain, options):
    """One recording is cut at random bytes. Whatever stands in whole chunks before the cut is there afterwards."""
    choose = random.Random(options.seed)
    bad = []
    with at_full_rate(build, domain) as vehicle:
        vehicle.start()
        time.sleep(10.0)
        vehicle.stop()
        with open(vehicle.files()[0], "rb") as file:
            data = file.read()
        whole = chunks(data)
        cut = vehicle.path("cut.mcap")
        for _ in range(options.truncations):
            size = choose.randrange(len(MAGIC), len(data))
            with open(cut, "wb") as file:
                file.write(data[:size])
            expected = max((count for behind, count in whole if behind <= size), default=0)
            code, said = vehicle.fathom("record", "--recover", cut)
            found = summary(cut)
            told = re.search(r"(\d+) messages", said)
            if code != 0 or found is None or not told or int(told.group(1)) != found[0] or found[0] < expected:
                bad.append(f"cut at byte {size} of {len(data)}: exit code {code}, expected at least {expected} messages, "
                           f"found {found and found[0]}: {said.strip()}")
            for name in os.listdir(vehicle.folder.name):
                if name.startswith("cut.mcap"):
                    os.remove(vehicle.path(name))
    print(f"{options.truncations} cuts of {len(data)} bytes: {'all recovered' if not bad else f'{len(bad)} BAD'}")
    print("\n".join(bad[:20]), end="\n" if bad else "")
    return not bad, {"truncations": options.truncations, "truncations_bad": len(bad)}
