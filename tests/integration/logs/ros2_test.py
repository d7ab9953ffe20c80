#!/usr/bin/env python3
"""`fathom import` of bags of ROS 2 that this test writes itself with the standard definitions: what went in comes out,
in the data set's axes and units. Usage: ros2_test.py FATHOM"""
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile

from mcap_encode import Bag, cdr, schema_text, stamp

START = 1_700_000_000_123_456_789
MS = 10**6
FILES = ("imu", "gps", "dvl", "depth", "heading", "mag", "baro", "airspeed")


def run(fathom, log, out, *more, code=0):
    done = subprocess.run([fathom, "import", log, "--out", out, *more], capture_output=True, text=True)
    assert done.returncode == code, (log, done.returncode, done.stdout, done.stderr)
    if code:
        assert done.stderr.startswith("fathom: ") and len(done.stderr.strip().splitlines()) == 1, done.stderr
        return done.stderr
    return json.load(open(os.path.join(out, "import.json")))


def table(path):
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    return math.nan if text == "" else float(text)


def nanoseconds(text):
    whole, _, part = text.partition(".")
    return (int(whole) * 10**9 + int(part.ljust(9, "0"))) if not text.startswith("-") else -nanoseconds(text[1:])


def near(row, want, tolerance=1e-12):
    for column, value in want.items():
        got = number(row.get(column, ""))
        same = (math.isnan(got) and math.isnan(value)) or abs(got - value) <= tolerance * max(1.0, abs(value))
        assert same, (column, got, value, row)


def multiply(a, b):
    (w, x, y, z), (W, X, Y, Z) = a, b
    return (w * W - x * X - y * Y - z * Z, w * X + x * W + y * Z - z * Y, w * Y - x * Z + y * W + z * X,
            w * Z + x * Y - y * X + z * W)


def turn(q, v):
    w, x, y, z = q
    return multiply(multiply(q, (0.0, *v)), (w, -x, -y, -z))[1:]


def about(axis, degrees):
    half = math.radians(degrees) / 2
    return (math.cos(half), *(math.sin(half) * a for a in axis))


def quaternion(q):
    return dict(zip("wxyz", q))


def vector(v):
    return dict(zip("xyz", v))


def header(t_ns, frame):
    return {"stamp": stamp(t_ns), "frame_id": frame}


def covariance(rng, n, unknown=False):
    out = [rng.uniform(-1e-3, 1e-3) for _ in range(n * n)]
    for i in range(n):
        out[i * n + i] = rng.uniform(1e-4, 4.0)
    if unknown:
        out[0] = -1.0
    return out


class Vehicle:
    """A bag, and what must come of it."""

    def __init__(self, seed, little=True, mounted=False):
        rng = random.Random(seed)
        self.bag = Bag()
        self.want = {name: [] for name in FILES}
        self.sources = {}
        turned = {"imu_link": about((0, 0, 1), 90.0), "dvl_link": about((1, 0, 0), 180.0)} if mounted else {}
        if mounted:
            def transform(parent, child, q, p):
                return {"header": header(0, parent), "child_frame_id": child,
                        "transform": {"translation": vector(p), "rotation": quaternion(q)}}
            self.bag.add("/tf_static", "tf2_msgs/TFMessage", START - 5 * MS, {"transforms": [
                transform("base_link", "plate", about((0, 1, 0), 0.0), (1.0, 0.0, 0.0)),
                transform("plate", "imu_link", turned["imu_link"], (0.5, 0.25, 0.125)),
                transform("base_link", "dvl_link", turned["dvl_link"], (0.0, 0.0, -1.0)),
                transform("base_link", "gps", (1.0, 0.0, 0.0, 0.0), (2.0, 0.25, 3.0))]}, little)
        for step in range(400):
            t = START + step * 10 * MS + rng.randrange(MS)
            logged = t + rng.randrange(100_000, 3 * MS)
            self.imu(rng, step, t, logged, turned.get("imu_link"), little)
            if step % 10 == 0:
                self.gps(rng, step, t, logged, little)
            if step % 20 == 5:
                self.dvl(rng, step, t, logged, turned.get("dvl_link"), little)
            if step % 5 == 2:
                self.pressure(rng, t, logged, little)
            if step % 4 == 1:
                field = [rng.uniform(-5e-5, 5e-5) for _ in range(3)]
                self.bag.add("/imu/mag", "sensor_msgs/MagneticField", logged,
                             {"header": header(t, "imu_link"), "magnetic_field": vector(field)}, little)
                m = turn(turned.get("imu_link", (1, 0, 0, 0)), field)
                self.want["mag"].append((t, logged, dict(zip(("mx_T", "my_T", "mz_T"), (m[0], -m[1], -m[2])))))
            if step % 50 == 0:
                self.bag.add("/rosout", "std_msgs/String", logged, {"data": "moving"}, little)

    def add(self, topic, kind, logged, value, little):
        self.bag.add(topic, kind, logged, value, little)
        self.sources.setdefault(topic, []).append(value)

    def imu(self, rng, step, t, logged, turned, little):
        rate = [rng.gauss(0, 0.2) for _ in range(3)]
        force = [rng.gauss(0, 0.5), rng.gauss(0, 0.5), 9.81 + rng.gauss(0, 0.5)]
        yaw, pitch, roll = rng.uniform(-180, 180), rng.uniform(-60, 60), rng.uniform(-170, 170)
        # Of the body in east-north-up, with forward-left-up axes; the sensor's follows by how it is mounted.
        body = multiply(about((0, 0, 1), yaw), multiply(about((0, 1, 0), pitch), about((1, 0, 0), roll)))
        q = multiply(body, turned) if turned else body
        attitude = covariance(rng, 3, unknown=step % 7 == 3)
        self.add("/imu/data", "sensor_msgs/Imu", logged, {
            "header": header(t, "imu_link"), "orientation": quaternion(q), "orientation_covariance": attitude,
            "angular_velocity": vector(rate), "angular_velocity_covariance": covariance(rng, 3),
            "linear_acceleration": vector(force),
            "linear_acceleration_covariance": covariance(rng, 3, unknown=step % 11 == 5)}, little)
        w, f = (turn(turned, v) if turned else v for v in (rate, force))
        if step % 11 == 5:
            f = [math.nan] * 3
        self.want["imu"].append((t, logged, {"gx_rad_s": w[0], "gy_rad_s": -w[1], "gz_rad_s": -w[2],
                                             "ax_m_s2": f[0], "ay_m_s2": -f[1], "az_m_s2": -f[2]}))
        if step % 7 != 3 and attitude[0] >= 0:
            self.want["heading"].append((t, logged, {"heading_deg": (90.0 - yaw) % 360.0,
                                                     "sigma_deg": math.degrees(math.sqrt(attitude[8]))}))

    def gps(self, rng, step, t, logged, little):
        status = (-1, 0, 1, 2)[step // 10 % 4]
        kind = step // 10 % 3 and 3
        fix, twist = covariance(rng, 3), covariance(rng, 6)
        lat, lon, alt = rng.uniform(-80, 80), rng.uniform(-179, 179), rng.uniform(-50, 3000)
        self.add("/gps/fix", "sensor_msgs/NavSatFix", logged, {
            "header": header(t, "gps"), "status": {"status": status, "service": 1}, "latitude": lat, "longitude": lon,
            "altitude": alt, "position_covariance": fix, "position_covariance_type": kind}, little)
        # East, north, up; of two fixes in three.
        v = [rng.gauss(0, 3) for _ in range(3)]
        moving = step // 10 % 3 != 1
        if moving:
            self.bag.add("/gps/vel", "geometry_msgs/TwistWithCovarianceStamped", logged + 5000, {
                "header": header(t, "gps"), "twist": {"twist": {"linear": vector(v)}, "covariance": twist}}, little)
        sigma = [math.sqrt(fix[i]) if kind else math.nan for i in (4, 0, 8)]
        nan = math.nan
        ve, vn, vu = v if moving else [nan] * 3
        sv = [math.sqrt(twist[i]) if moving else nan for i in (7, 0, 14)]
        self.want["gps"].append((t, logged, {
            "lat_deg": lat, "lon_deg": lon, "alt_m": alt, "sigma_n_m": sigma[0], "sigma_e_m": sigma[1],
            "sigma_d_m": sigma[2], "vn_m_s": vn, "ve_m_s": ve, "vd_m_s": -vu, "sigma_vn_m_s": sv[0],
            "sigma_ve_m_s": sv[1], "sigma_vd_m_s": sv[2], "fix": {-1: 0, 0: 5, 1: 4, 2: 4}[status]}))

    def dvl(self, rng, step, t, logged, turned, little):
        v = [rng.uniform(-2, 2) for _ in range(3)]
        valid = step // 20 % 4 != 2
        beams = [{"id": i, "velocity": rng.uniform(-1, 1), "distance": rng.uniform(1, 40), "valid": rng.random() < 0.8}
                 for i in range(4)]
        fom, altitude = rng.uniform(1e-3, 0.1), rng.uniform(1, 30) if valid else -1.0
        self.add("/dvl/data", "dvl_msgs/DVL", logged, {
            "header": header(t, "dvl_link"), "time": 200.0, "velocity": vector(v), "fom": fom, "altitude": altitude,
            "beams": beams, "velocity_valid": valid, "form": "json_v3.1"}, little)
        # With a transform its axes are the frame's, forward-left-up of the vehicle behind it; else the instrument's.
        out = turn(turned, v) if turned else v
        out = (out[0], -out[1], -out[2]) if turned else out
        nan = math.nan
        row = dict(zip(("vx_m_s", "vy_m_s", "vz_m_s"), out if valid else [nan] * 3), sigma_m_s=fom if valid else nan,
                   altitude_m=altitude if valid else nan)
        for i, beam in enumerate(beams):
            row[f"b{i + 1}_m_s"] = beam["velocity"] if valid and beam["valid"] and not turned else nan
        self.want["dvl"].append((t, logged, row))

    def pressure(self, rng, t, logged, little):
        pressure, variance = rng.uniform(1.0e5, 9.0e5), rng.choice([0.0, 4e4])
        self.add("/pressure", "sensor_msgs/FluidPressure", logged, {
            "header": header(t, "pressure_link"), "fluid_pressure": pressure, "variance": variance}, little)
        per_metre = 1025.0 * 9.80665
        self.want["depth"].append((t, logged, {
            "depth_m": (pressure - 101325.0) / per_metre,
            "sigma_m": math.sqrt(variance) / per_metre if variance else math.nan}))


def write(path, blob):
    open(path, "wb").write(blob)
    return path


def check(vehicle, out, zero_ns):
    """Every row of every file."""
    count = 0
    for name, rows in vehicle.want.items():
        have = table(os.path.join(out, name + ".csv"))
        assert len(have) == len(rows), (name, len(have), len(rows))
        # mag.csv is in the order of its instants, the data set's files in that of arrival.
        rows = sorted(rows, key=lambda row: row[0] if name == "mag" else row[1] // 1000)
        for got, (t, logged, want) in zip(have, rows):
            assert nanoseconds(got["t_s"]) == t - zero_ns, (name, got, t - zero_ns)
            if name != "mag":
                assert nanoseconds(got["t_received_s"]) == logged // 1000 * 1000 - zero_ns, (name, got)
            near(got, want, 1e-9 if name == "heading" else 1e-11)
            count += len(want)
    return count


def check_sources(vehicle, out):
    """Each field of the messages with its own name."""
    for topic, rows in vehicle.sources.items():
        have = table(os.path.join(out, "sources", topic[1:].replace("/", ".") + ".0.csv"))
        assert len(have) == len(rows), (topic, len(have))
        for got, row in zip(have, rows):
            for column, value in flat(row).items():
                assert number(got[column]) == value, (topic, column, got[column], value)


def flat(value, prefix=""):
    out = {}
    for name, one in value.items():
        label = prefix + name
        if isinstance(one, dict):
            out |= flat(one, label + ".")
        elif isinstance(one, list) and one and isinstance(one[0], dict):
            out[label + ".length"] = len(one)
            for i, inner in enumerate(one):
                out |= flat(inner, f"{label}[{i}].")
        elif isinstance(one, list):
            out |= {f"{label}[{i}]": inner for i, inner in enumerate(one)}
        elif not isinstance(one, str):
            out[label] = one
    return out


def values(fathom, folder):
    count = 0
    for little in (True, False):
        for mounted in (False, True):
            vehicle = Vehicle(7 + 2 * little + mounted, little, mounted)
            zero = min(logged for rows in vehicle.want.values() for _, logged, _ in rows) // 1000 * 1000
            for compression, kinds in (("", {}), ("lz4", {}), ("zstd", {}), ("", {"summary": False}),
                                       ("", {"chunked": False})):
                blob = vehicle.bag.bytes(compression, **kinds)
                path = write(os.path.join(folder, "bag.mcap"), blob)
                out = os.path.join(folder, "out")
                report = run(fathom, path, out)
                assert report["lost"]["count"] == 0, report["lost"]
                assert report["messages"]["/rosout"] == 8
                assert report["files"]["dvl"]["from"] == "/dvl/data"
                count += check(vehicle, out, zero)
                check_sources(vehicle, out)
            if mounted:
                notes = " ".join(report["notes"])
                assert "gps is at 0.500, 0.000, -2.875 m" in notes, notes  # right and down are positive
            run(fathom, path, out, "--time", "utc")
            utc = 1_577_836_800 * 10**9
            check(vehicle, out, utc)
    return count


def split(fathom, folder):
    """A folder of files is one bag; each has its own numbers of channels, and only the first has the mounting."""
    vehicle = Vehicle(9, mounted=True)
    bag = os.path.join(folder, "rosbag2")
    os.mkdir(bag)
    names = {number: topic for (topic, _, _), number in vehicle.bag.channels.items()}
    kinds = {schema: key for key, schema in vehicle.bag.schemas.items()}
    described = {number: kinds[schema] for (_, schema, _), number in vehicle.bag.channels.items()}
    size = 60
    parts = [vehicle.bag.messages[i:i + size] for i in range(0, len(vehicle.bag.messages), size)]
    assert len(parts) > 10
    for i, messages in enumerate(parts):
        part = Bag()
        for number, t, data in messages:
            name, definition, encoding = described[number]
            part.raw(part.channel(names[number], name.replace("/msg/", "/"), definition, encoding), t, data)
        write(os.path.join(bag, f"rosbag2_{i}.mcap"), part.bytes("zstd"))
    write(os.path.join(bag, "metadata.yaml"), b"")
    out = os.path.join(folder, "split")
    report = run(fathom, bag, out)
    assert report["lost"]["count"] == 0, report["lost"]
    check(vehicle, out, min(logged for rows in vehicle.want.values() for _, logged, _ in rows) // 1000 * 1000)
    assert len(os.listdir(os.path.join(out, "sources"))) == 6, os.listdir(os.path.join(out, "sources"))
    write(os.path.join(bag, "rosbag2_3.mcap"), b"no bag")
    assert "rosbag2_3.mcap" in run(fathom, bag, out, code=3)


def damaged(fathom, folder):
    """Cut anywhere, and with garbage in it: what is whole comes out; nothing crashes."""
    vehicle = Vehicle(3)
    blob = vehicle.bag.bytes("zstd", chunk=40)
    out = os.path.join(folder, "cut")
    rng = random.Random(5)
    whole = len(vehicle.want["imu"])
    had = 0
    for cut in sorted(rng.sample(range(len(blob) // 3, len(blob)), 12)):
        run(fathom, write(os.path.join(folder, "cut.mcap"), blob[:cut]), out)
        now = len(table(os.path.join(out, "imu.csv")))
        assert had <= now <= whole
        had = now
    assert had > whole * 0.8
    for _ in range(12):
        bad = bytearray(blob)
        at = rng.randrange(100, len(blob) - 300)
        bad[at:at + 200] = rng.randbytes(200)
        path = write(os.path.join(folder, "bad.mcap"), bad)
        done = subprocess.run([fathom, "import", path, "--out", out], capture_output=True, text=True)
        assert done.returncode in (0, 3), (done.returncode, done.stderr)
        if done.returncode == 0 and at < len(blob) // 2:
            report = json.load(open(os.path.join(out, "import.json")))
            assert report["lost"]["count"] > 0 or "not" in " ".join(report["notes"]), report
    # Unpacked, a message alone is hurt: it is named, and all others are there.
    bag = Vehicle(4).bag
    number = bag.channel("/imu/data", "sensor_msgs/Imu")
    channel, t, data = next(m for m in bag.messages if m[0] == number)
    at = bag.messages.index((channel, t, data))
    for hurt, what in ((data[:-1], "linear_acceleration_covariance[8]"), (data[:12] + b"\xff\xff\0\0" + data[16:],
                       "header.frame_id"), (b"\0\7" + data[2:], "encapsulation 0x0007"), (data + b"\0" * 8, "8 bytes behind"),
                       (b"", "0 bytes")):
        bag.messages[at] = (channel, t, hurt)
        report = run(fathom, write(os.path.join(folder, "one.mcap"), bag.bytes()), out)
        assert report["lost"]["count"] == 1, report["lost"]
        said = report["lost"]["first"][0]["what"]
        assert "/imu/data" in said and "sensor_msgs/Imu" in said and what in said, said
        assert len(table(os.path.join(out, "imu.csv"))) == whole - 1


def choices(fathom, folder):
    out = os.path.join(folder, "chosen")
    bag = Bag()
    for i in range(50):
        t = START + i * 100 * MS
        bag.add("/imu", "sensor_msgs/Imu", t, {"header": header(t, "imu"), "linear_acceleration": {"z": 9.8}})
        bag.add("/odometry/filtered", "nav_msgs/Odometry", t, {
            "header": header(t, "odom"), "child_frame_id": "base_link",
            "twist": {"twist": {"linear": {"x": 1.0 + i, "y": 2.0, "z": 3.0}}}})
        bag.add("/a/dvl", "marine_acoustic_msgs/Dvl", t, {
            "header": header(t, "dvl"), "velocity_mode": 1 + i % 2, "velocity": {"x": 1.0, "y": 2.0, "z": 3.0},
            "velocity_covar": [0.01] + [0.0] * 3 + [0.04] + [0.0] * 3 + [0.04], "altitude": 7.0})
        bag.add("/b/dvl", "uuv_msgs/DVL", t, {
            "header": header(t, "dvl"), "velocity": {"x": 1.0, "y": 2.0, "z": 3.0},
            "velocity_covariance": [-1.0 if i % 3 == 0 else 0.0] * 9, "altitude": 7.0, "beams": [{}] * 4})
        bag.add("/air", "sensor_msgs/FluidPressure", t, {"header": header(t, "air"), "fluid_pressure": 100000.0 - i})
        bag.add("/ctd", "sensor_msgs/FluidPressure", t, {"header": header(t, "ctd"), "fluid_pressure": 2e5})
    path = write(os.path.join(folder, "bag.mcap"), bag.bytes())
    report = run(fathom, path, out)
    assert "heading" not in report["files"], "an attitude that never changes is none"
    assert report["files"]["dvl"]["from"] == "/a/dvl"
    assert report["files"]["dvl"]["others"] == ["/b/dvl", "/odometry/filtered"], report["files"]["dvl"]
    dvl = table(os.path.join(out, "dvl.csv"))
    near(dvl[0], {"vx_m_s": 1.0, "vy_m_s": 2.0, "vz_m_s": 3.0, "sigma_m_s": math.sqrt(0.03), "altitude_m": 7.0})
    assert [row["mode"] for row in dvl[:2]] == ["bottom", "water"]
    assert len(table(os.path.join(out, "baro.csv"))) == 50 and len(table(os.path.join(out, "depth.csv"))) == 50
    near(table(os.path.join(out, "baro.csv"))[3], {"pressure_Pa": 99997.0})
    run(fathom, path, out, "--from", "dvl=/b/dvl")
    dvl = table(os.path.join(out, "dvl.csv"))
    near(dvl[1], {"vx_m_s": 1.0, "vy_m_s": -2.0, "vz_m_s": -3.0, "sigma_m_s": math.nan})
    assert dvl[0]["vx_m_s"] == "" and dvl[3]["vx_m_s"] == ""
    run(fathom, path, out, "--from", "dvl=/b/dvl", "--axes", "/b/dvl=frd", "--mounting", "dvl=0,0,90")
    near(table(os.path.join(out, "dvl.csv"))[1], {"vx_m_s": -2.0, "vy_m_s": 1.0, "vz_m_s": 3.0})
    run(fathom, path, out, "--from", "dvl=/odometry/filtered")
    near(table(os.path.join(out, "dvl.csv"))[9], {"vx_m_s": 10.0, "vy_m_s": -2.0, "vz_m_s": -3.0})
    run(fathom, path, out, "--surface-pressure", "100000", "--water-density", "1000")
    near(table(os.path.join(out, "depth.csv"))[0], {"depth_m": 1e5 / 9806.65})
    for arguments, said in ((("--from", "dvl=/c"), "/odometry/filtered"), (("--axes", "/c=flu"), "/odometry/filtered"),
                            (("--mounting", "c=0,0,0"), "base_link")):
        assert said in run(fathom, path, out, *arguments, code=3)
    for arguments in (("--axes", "/a/dvl=xyz"), ("--axes", "frd"), ("--mounting", "dvl=1,2"), ("--from", "x=/a"),
                      ("--mounting", "dvl=1,2,3,4"), ("--mounting", "dvl=1,2,nan"), ("--water-density", "1")):
        run(fathom, path, out, *arguments, code=2)


def clocks(fathom, folder):
    """Stamps of a simulation, of a device's own clock, and none."""
    out = os.path.join(folder, "clocks")
    for imu_s, gps_s, note, first in ((5, 5, "other clock", 5 / 1e9), (None, 17, "gps", None), (None, None, "", None)):
        bag = Bag()
        for i in range(20):
            t = START + i * 100 * MS
            own = {"imu": imu_s, "gps": gps_s}
            frame = {k: header(0 if v is None else v * 10**9 + i * 50 * MS, k) for k, v in own.items()}
            bag.add("/imu", "sensor_msgs/Imu", t, {"header": frame["imu"], "linear_acceleration": {"z": 9.8}})
            bag.add("/gps", "sensor_msgs/NavSatFix", t, {"header": frame["gps"], "latitude": 1.0, "longitude": 2.0})
        report = run(fathom, write(os.path.join(folder, "clocks.mcap"), bag.bytes()), out)
        assert note in " ".join(report["notes"]), report["notes"]
        step = 0.05 if imu_s == gps_s == 5 else 0.1
        for name in ("imu", "gps"):
            times = [float(row["t_s"]) for row in table(os.path.join(out, name + ".csv"))]
            assert len(times) == 20 and all(abs(t - i * step) < 1e-6 for i, t in enumerate(times)), (name, times)
        assert (report["utc_of_start"] is None) == (step == 0.05)


def refused(fathom, folder):
    out = os.path.join(folder, "refused")
    path = os.path.join(folder, "refused.mcap")
    run(fathom, write(path, b"\x89MCAP0\r\n"), out, code=3)
    run(fathom, write(path, b"\x89MCAP1\r\n"), out, code=3)
    bag = Bag()
    bag.add("/text", "std_msgs/String", START, {"data": "x"})
    assert "sensor_msgs/msg/Imu" in run(fathom, write(path, bag.bytes()), out, code=3)
    said = subprocess.run([fathom, "solve", path, "--out", os.path.join(folder, "nav.csv")], capture_output=True, text=True)
    assert said.returncode == 3 and "fathom import" in said.stderr, said.stderr
    bag = Bag()
    bag.raw(bag.channel("/imu", "sensor_msgs/Imu"), START, b"")
    assert "/imu: sensor_msgs/Imu at log time 1700000000.123456789: 0 bytes" in run(fathom, write(path, bag.bytes()), out,
                                                                                    code=3)
    # A topic whose layout cannot be known is named with the reason; the others come out.
    good = {"header": header(START, "f"), "fluid_pressure": 1e5}
    layout = schema_text("sensor_msgs/Imu")
    for definition, encoding, what in (
            (layout.replace("float64 z", "float65 z"), "ros2msg", "float65"), ("", "ros2msg", "empty"),
            (layout.split("=====")[0], "ros2msg", "not defined"), (layout, "ros2idl", "ros2idl"),
            (layout.replace("float64[9]", "float64[x]"), "ros2msg", "no size"),
            ("sensor_msgs/Imu again\n", "ros2msg", "within itself"), ("uint8[9999999] a\n", "ros2msg", "numbers a message"),
            (layout.replace("string frame_id", "wstring frame_id"), "ros2msg", "wstring")):
        bag = Bag()
        bag.add("/air", "sensor_msgs/FluidPressure", START, good)
        bag.raw(bag.channel("/imu", "sensor_msgs/Imu", definition, encoding), START, cdr("sensor_msgs/Imu", {}))
        report = run(fathom, write(path, bag.bytes()), out)
        said = report["lost"]["first"][0]["what"]
        assert what in said and "/imu" in said and "sensor_msgs/msg/Imu" in said, (what, said)
        assert report["files"]["baro"]["rows"] == 1
    # A topic's name is no way out of the folder.
    bag = Bag()
    bag.add("/../../../x/..", "sensor_msgs/FluidPressure", START, good)
    run(fathom, write(path, bag.bytes()), out)
    assert os.listdir(os.path.join(out, "sources")) == ["x....0.csv"], os.listdir(os.path.join(out, "sources"))


def main():
    fathom = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        count = values(fathom, folder)
        choices(fathom, folder)
        clocks(fathom, folder)
        split(fathom, folder)
        damaged(fathom, folder)
        refused(fathom, folder)
    print(f"{count} values of ROS 2 messages as they went in")


main()
