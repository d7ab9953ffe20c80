"""Whether `fathom replay --verify` is exact: in every scenario, over restarts, takeovers, late samples, a clock that is set."""
import glob
import json
import os
import re
import time

from vehicle import ROOT, Vehicle, wait_until


def proof(vehicle, name):
    """Exit code 0, and every run that is in the recording equal to the last bit. (good, states, what was said)"""
    vehicle.stop()
    code, said = vehicle.fathom("replay", *vehicle.files(), "--verify")
    lines = [line for line in said.splitlines() if ": fusion" in line]
    states = sum(int(found) for found in re.findall(r"last bit: (\d+) navigation states", said))
    good = code == 0 and bool(lines) and all("equal to the last bit" in line for line in lines)
    print(f"{name}: {'exact' if good else 'NOT EXACT'}, {states} states of {len(lines)} runs")
    if not good:
        print(said)
        vehicle.keep_recordings(name)
    return good, states


def scenario(build, domain, name, seconds):
    with Vehicle(build, domain, name) as vehicle:
        vehicle.start()
        time.sleep(seconds)
        return proof(vehicle, f"scenario {name}")


def scenarios(build, domain, seconds):
    names = sorted(os.path.basename(path)[:-5] for path in glob.glob(os.path.join(ROOT, "deploy/config/scenarios/*.json")))
    return [scenario(build, domain, name, seconds) for name in names]


def killed(build, domain, seconds):
    """Fusion is killed and goes on from its checkpoint, five times, and once it begins anew."""
    with Vehicle(build, domain) as vehicle:
        vehicle.start()
        for again in range(6):
            time.sleep(seconds / 6.0 + 0.037 * again)
            vehicle.kill("fusion")
            if again == 3:
                os.remove(vehicle.path("fusion.checkpoint"))
            vehicle.start("fusion")
        time.sleep(seconds / 6.0)
        return [proof(vehicle, "fusion killed six times")]


def reconfigured(build, domain, seconds):
    """Fusion is stopped and started with another configuration, twice, and then with the first one again."""
    with Vehicle(build, domain) as vehicle:
        vehicle.start()
        for sets in (["engine.horizon_s=3"], ["engine.imu.gyro_bias_sigma_deg_h=5"], []):
            time.sleep(seconds / 4.0)
            vehicle.kill("fusion")
            vehicle.start("fusion", sets=sets)
        time.sleep(seconds / 4.0)
        return [proof(vehicle, "fusion with three configurations")]


def takeovers(build, domain, seconds):
    """The one of two fusions that leads is killed and started again, ten times, each time another one."""
    with Vehicle(build, domain, standby=True) as vehicle:
        vehicle.start()
        time.sleep(15.0)
        for again in range(10):
            leader = ("fusion", "fusion_standby")[again % 2]
            wait_until(lambda: in_step(vehicle), 60)
            vehicle.kill(leader)
            time.sleep(2.0)
            vehicle.start(leader)
            time.sleep(seconds / 10.0)
        return [proof(vehicle, "ten takeovers")]


def in_step(vehicle):
    """The last word of each fusion: it leads, or stands by in step."""
    last = [[line for line in vehicle.log(name).splitlines() if re.search("leading|standing by|behind|listening", line)][-1:]
            for name in ("fusion", "fusion_standby")]
    return all(one and re.search("leading|standing by", one[0]) for one in last)


def late(build, domain, seconds):
    """USBL fixes that come four seconds late, often, and a DVL that does by one."""
    with open(os.path.join(ROOT, "deploy/config/scenarios/survey.json"), encoding="utf-8") as text:
        changed = json.load(text)
    changed["sensors"]["usbl"].update({"rate_hz": 1.0, "latency_s": 4.0, "maximum_latency_s": 4.9})
    changed["sensors"]["dvl"].update({"latency_s": 1.0})
    with Vehicle(build, domain) as vehicle:
        file = vehicle.path("late.json")
        with open(file, "w", encoding="utf-8") as text:
            json.dump(changed, text)
        words = vehicle.commands["simulator"]
        vehicle.commands["simulator"] = [f"scenario={file}" if word.startswith("scenario=") else word for word in words]
        vehicle.start()
        time.sleep(seconds)
        return [proof(vehicle, "late USBL")]


def joined(build, domain, seconds):
    """The recorder comes when fusion has been under way for a while: what fusion took before is not in the recording."""
    with Vehicle(build, domain) as vehicle:
        vehicle.start(*[name for name in vehicle.commands if name not in ("recorder", "simulator")])
        time.sleep(2.0)
        vehicle.start("simulator")
        time.sleep(seconds / 3.0)
        vehicle.start("recorder")
        time.sleep(seconds / 3.0)
        return [proof(vehicle, "a recorder that came later")]


def clock(build, domain, seconds):
    """UTC of the host is set an hour ahead, an hour back and back again, with a bridge and fusion started anew in between."""
    library = glob.glob("/usr/lib/*/faketime/libfaketimeMT.so.1")
    if not library:
        print("clock set: libfaketime is not there (package faketime)")
        return [(False, 0)]
    with Vehicle(build, domain) as vehicle:
        file = vehicle.path("utc")

        def set_clock(how):
            with open(file + ".new", "w", encoding="utf-8") as text:
                text.write(how + "\n")
            os.rename(file + ".new", file)

        set_clock("+0")
        vehicle.service_environment = {"LD_PRELOAD": library[0], "FAKETIME_TIMESTAMP_FILE": file,
                                       "FAKETIME_CACHE_DURATION": "1", "FAKETIME_DONT_FAKE_MONOTONIC": "1"}
        vehicle.start()
        for how in ("+3600", "-3600", "+0"):
            time.sleep(seconds / 4.0)
            set_clock(how)
            time.sleep(2.0)
            vehicle.kill("gps_bridge")
            vehicle.start("gps_bridge")
            vehicle.kill("fusion")
            vehicle.start("fusion")
        time.sleep(seconds / 4.0)
        return [proof(vehicle, "clock set three times")]
