"""What was found of a drawn vehicle, held against what is true of it."""
import copy
import csv
import math

import turns

AXES = ("x", "y", "z")
# What the show asks for.
MOUNTING_DEG, LEVER_M, LATE_S, NOISE, INIT_S = 0.2, 0.05, 0.005, 0.2, 60.0
SIGMAS = 3.0
COUNTED_S = 8.0
# Of the demonstration's survey vehicle: horizontal rms, roll and pitch rms, yaw rms. The axes of the body are those of the
# box of the inertial unit as it is screwed down; the constant turn against the drawn ones is taken out.
LIMITS = {"horizontal_m": 3.0, "tilt_deg": 0.18, "yaw_deg": 1.3}
FROM_S = 240.0


class DoesNotHold(Exception):
    def __init__(self, what):
        super().__init__("; ".join(what))
        self.what = what


def instrument(vehicle, kind):
    return next(one for one in vehicle["instruments"] if one["kind"] == kind)


def true_vehicle(found, truth):
    """The file that init wrote, with what is true instead of what was found."""
    out = copy.deepcopy(found)
    for kind in ("imu", "dvl"):
        C = truth["C_BI"] if kind == "imu" else truth["C_BD"]
        instrument(out, kind)["mounting_rpy_deg"] = turns.to_rpy(C)
    imu = instrument(out, "imu")
    imu["position_m"] = [0.0, 0.0, 0.0]
    imu.setdefault("fusion", {}).update({"angle_random_walk_deg_sqrt_h": truth["gyro"],
                                         "velocity_random_walk_m_s_sqrt_h": truth["accelerometer"]})
    for kind, lever in truth["lever"].items():
        instrument(out, kind)["position_m"] = lever
    for kind, late_s in truth["late_s"].items():
        instrument(out, kind).setdefault("fusion", {})["latency_s"] = late_s
    instrument(out, "heading")["mounting_rpy_deg"] = [0.0, 0.0, 0.0]
    return out


def errors(reference, solution, C_from_true):
    """rms of the horizontal position, m, and of tilt and yaw, degrees, from FROM_S on. C_from_true: true body axes
    into those of the solution."""
    with open(solution, encoding="utf-8") as file:
        states = list(csv.DictReader(file))
    sums, count, i = [0.0, 0.0, 0.0], 0, 0
    with open(reference, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            t = float(row["t_s"])
            while i + 1 < len(states) and float(states[i + 1]["t_s"]) <= t + 1e-4:
                i += 1
            state = states[i]
            if t < FROM_S or abs(float(state["t_s"]) - t) > 0.011:
                continue
            latitude = math.radians(float(row["lat_deg"]))
            north = math.radians(float(state["lat_deg"]) - float(row["lat_deg"])) * 6.37e6
            east = math.radians(float(state["lon_deg"]) - float(row["lon_deg"])) * 6.37e6 * math.cos(latitude)
            true = turns.from_rpy([float(row[f"{a}_deg"]) for a in ("roll", "pitch", "yaw")])
            seen = turns.from_rpy([float(state[f"{a}_deg"]) for a in ("roll", "pitch", "yaw")])
            # About north, east, down.
            off = turns.rotation_vector(turns.product(turns.product(seen, C_from_true), turns.transposed(true)))
            sums[0] += north * north + east * east
            sums[1] += (off[0] ** 2 + off[1] ** 2) / 2.0
            sums[2] += off[2] ** 2
            count += 1
    if count == 0:
        return {name: math.inf for name in LIMITS}
    return {name: math.sqrt(sum_ / count) for name, sum_ in zip(LIMITS, sums)}


class Row:
    HEAD = ("seed  instruments found     mounting, deg      lever, m           latency, ms        noise     beyond  "
            "known vehicle      found vehicle\n"
            "      of    in, s            told  worst        told  worst        told  worst        worst, %  3 sigma "
            "m     deg   deg     m     deg   deg")

    def __init__(self, seed):
        self.seed, self.wrong = seed, []
        self.of = self.right = 0
        self.took_s = math.nan
        self.told = {"mounting": [], "lever": [], "latency": []}
        self.asked = {"mounting": 0, "lever": 0, "latency": 0}
        self.noise, self.ratios = [], []
        self.known = self.found = {name: math.nan for name in LIMITS}

    def init(self, scenario, vehicle, took_s):
        self.took_s = took_s
        if took_s > INIT_S + 2.0:
            self.wrong.append(f"init took {took_s:.0f} s")
        for kind, sensor in scenario["sensors"].items():
            self.of += 1
            seen = [one for one in vehicle["instruments"] if one["kind"] == kind]
            if len(seen) != 1:
                self.wrong.append(f"{kind} ({sensor['protocol']}, {sensor['link']['type']}) was found {len(seen)} times")
            elif seen[0]["protocol"] != sensor["protocol"]:
                self.wrong.append(f"{kind}: {sensor['protocol']} was taken for {seen[0]['protocol']}")
            # Counted over eight seconds, of arrivals that come up to two seconds late.
            elif abs(seen[0]["rate_hz"] / sensor["rate_hz"] - 1.0) > max(0.05, 2.0 / (COUNTED_S * sensor["rate_hz"])):
                self.wrong.append(f"{kind}: {sensor['rate_hz']} Hz were counted as {seen[0]['rate_hz']}")
            else:
                self.right += 1

    def _claim(self, group, name, off, sigma, known, limit):
        self.asked[group] += 1
        if not known:
            return
        self.told[group].append(abs(off))
        self.ratios.append(abs(off) / sigma)
        if abs(off) > limit:
            self.wrong.append(f"{name}: {off:.4g} off, {limit} is asked for, its sigma is {sigma:.2g}")
        if abs(off) > SIGMAS * sigma:
            self.wrong.append(f"{name}: {off:.4g} off is {abs(off) / sigma:.1f} of its sigmas")

    def commission(self, said, vehicle, truth):
        findings = {(one["sensor"], one["what"]): one for one in said["findings"]}

        def of(sensor, what):
            if (sensor, what) not in findings:
                raise DoesNotHold([f"commission says nothing of {sensor} {what}"])
            return findings[sensor, what]

        C_BI = turns.from_rpy(instrument(vehicle, "imu")["mounting_rpy_deg"])
        C_BD = turns.from_rpy(instrument(vehicle, "dvl")["mounting_rpy_deg"])
        # True body axes into those of the file.
        self.C = turns.product(C_BI, turns.transposed(truth["C_BI"]))
        apart = math.hypot(*turns.rotation_vector(self.C))
        if apart > 10.0:
            self.wrong.append(f"the inertial unit is mounted {apart:.0f} degrees otherwise")
            return
        # What stands in the file, and what is claimed beyond it.
        claims = [of("dvl", f"turn_{axis}") for axis in AXES]
        claimed = turns.product(C_BD, turns.from_vector([claim["value"] for claim in claims]))
        off = turns.rotation_vector(turns.product(turns.transposed(turns.product(self.C, truth["C_BD"])), claimed))
        for axis, claim in zip(AXES, claims):
            self._claim("mounting", f"dvl about {axis}, deg", off[AXES.index(axis)], claim["sigma"], claim["known"],
                        MOUNTING_DEG)
        for sensor, lever in truth["lever"].items():
            true = turns.applied(self.C, lever)
            for axis in range(3):
                found = of(sensor, f"lever_{AXES[axis]}")
                self._claim("lever", f"{sensor} lever {AXES[axis]}, m", found["value"] - true[axis], found["sigma"],
                            found["known"], LEVER_M)
        for sensor, late_s in truth["late_s"].items():
            found = findings.get((sensor, "latency"))
            if found is None:
                self.asked["latency"] += 1
                continue
            self._claim("latency", f"{sensor} latency, s", (found["value"] or 0.0) - late_s, found["sigma"] or 1.0,
                        found["known"], LATE_S)
        for what, key in (("gyro_noise", "gyro"), ("accelerometer_noise", "accelerometer")):
            found = of("imu", what)
            self.noise.append(found["value"] / truth[key] - 1.0)
            self.ratios.append(abs(found["value"] - truth[key]) / found["sigma"])
            if self.ratios[-1] > SIGMAS:
                self.wrong.append(f"{what}: {self.ratios[-1]:.1f} of its sigmas off")
            if abs(self.noise[-1]) > NOISE:
                self.wrong.append(f"{what}: {100 * self.noise[-1]:.0f} % off")
        for (sensor, what), one in findings.items():
            if one["kind"] == "instability" and one["known"]:
                self.wrong.append(f"{sensor} {what} is claimed of a log that cannot tell it")
            if one["severity"] == "wrong":
                self.wrong.append(f"after --apply still wrong: {one['text']}")

    def navigation(self, reference, known, found, vehicle, truth):
        one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        self.known = errors(reference, known, one)
        self.found = errors(reference, found, self.C)
        for name, limit in LIMITS.items():
            if self.found[name] > limit and self.found[name] > 1.05 * self.known[name]:
                self.wrong.append(f"navigation: {name} {self.found[name]:.3g} rms, limit {limit}, "
                                  f"{self.known[name]:.3g} with the known vehicle")

    def text(self):
        def group(name, scale):
            told = self.told[name]
            worst = f"{scale * max(told):.3g}" if told else "-"
            return f"{len(told):3d}/{self.asked[name]:<3d} {worst:8s}    "

        noise = f"{100 * max(map(abs, self.noise)):.0f}" if self.noise else "-"
        beyond = sum(ratio > SIGMAS for ratio in self.ratios)
        navigation = "  ".join(" ".join(f"{errors[name]:5.3g}" for name in LIMITS) for errors in (self.known, self.found))
        return (f"{self.seed:4d}  {self.right:2d}/{self.of:<2d} {self.took_s:5.1f}            {group('mounting', 1)}"
                f"{group('lever', 1)}{group('latency', 1000)}{noise:10s}{beyond:3d}     {navigation}"
                f"{'   DOES NOT HOLD' if self.wrong else ''}")

    def figures(self):
        return {"seed": self.seed, "holds": not self.wrong, "found": self.right, "of": self.of, "took_s": self.took_s,
                "told": self.told, "asked": self.asked, "noise": self.noise, "ratios": self.ratios,
                "known": self.known, "navigation": self.found, "wrong": self.wrong}


def summary(rows):
    """The worst of all vehicles."""
    out = {"vehicles": len(rows), "vehicles_that_hold": sum(row["holds"] for row in rows),
           "instruments_not_found": sum(row["of"] - row["found"] for row in rows),
           "init_s": max(row["took_s"] for row in rows)}
    for name in ("mounting", "lever", "latency"):
        told = [off for row in rows for off in row["told"][name]]
        asked = sum(row["asked"][name] for row in rows)
        out[f"{name}_told_share"] = len(told) / asked if asked else 0.0
        out[f"{name}_worst"] = max(told, default=math.nan)
    ratios = [ratio for row in rows for ratio in row["ratios"]]
    out["claims"] = len(ratios)
    out["beyond_3_sigma"] = sum(ratio > SIGMAS for ratio in ratios)
    out["within_1_sigma_share"] = sum(ratio < 1.0 for ratio in ratios) / max(1, len(ratios))
    out["noise_worst"] = max((abs(x) for row in rows for x in row["noise"]), default=math.nan)
    for name in LIMITS:
        out[f"found_{name}"] = max(row["navigation"][name] for row in rows)
        out[f"known_{name}"] = max(row["known"][name] for row in rows)
    return out
