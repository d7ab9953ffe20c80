#!/usr/bin/env python3
"""`fathom import` of PX4 logs against a decoder that shares no code with it.
Usage: ulog_test.py FATHOM FOLDER-OF-LOGS"""
import csv
import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

from ulog_decode import decode

KINDS = ["sensor_combined", "vehicle_imu", "sensor_accel", "sensor_gyro", "vehicle_gps_position", "sensor_gps",
         "airspeed", "airspeed_validated", "differential_pressure", "vehicle_air_data", "sensor_baro",
         "vehicle_magnetometer", "sensor_mag"]


def run(fathom, log, out, *more):
    done = subprocess.run([fathom, "import", log, "--out", out, *more], capture_output=True, text=True)
    assert done.returncode == 0, (log, done.returncode, done.stderr)
    return json.load(open(os.path.join(out, "import.json")))


def table(path):
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return [{k: float(v) if v not in ("", "nan") else math.nan for k, v in row.items()
                 if k not in ("north",)} for row in csv.DictReader(file)]


def same(a, b, tolerance=0.0):
    return (math.isnan(a) and math.isnan(b)) or a == b or abs(a - b) <= tolerance * max(1.0, abs(b))


def check_sources(truth, out):
    """Every message of the kinds, every field, to the last bit."""
    count = 0
    for (topic, multi), (columns, rows) in truth.items():
        if topic not in KINDS or not rows:
            continue
        have = table(os.path.join(out, "sources", f"{topic}.{multi}.csv"))
        assert len(have) == len(rows), (topic, multi, len(have), len(rows))
        for got, want in zip(have, rows):
            assert same(got["t_s"], want["timestamp"] * 1e-6, 1e-15), (topic, got["t_s"], want["timestamp"])
            for column in columns:
                assert same(got[column], want[column]), (topic, multi, column, got[column], want[column])
                count += 1
    return count


def valid_us(row):
    """When a message holds: its sample's time where the log gives a sound one."""
    sample = row.get("timestamp_sample", 0)
    return sample if 0 < sample <= row["timestamp"] and row["timestamp"] - sample < 10e6 else row["timestamp"]


def by_arrival(rows):
    return sorted(rows, key=lambda row: row["timestamp"])


def check_imu(truth, report, out):
    topic, multi = report["files"]["imu"]["from"].split(":")
    rows = by_arrival(truth[(topic, int(multi))][1])
    have = table(os.path.join(out, "imu.csv"))
    assert len(have) == len(rows)
    for got, row in zip(have, rows):
        if topic == "vehicle_imu":
            t_us = valid_us(row)
            w = [row[f"delta_angle[{i}]"] / (row["delta_angle_dt"] / 1e6) for i in range(3)]
            f = [row[f"delta_velocity[{i}]"] / (row["delta_velocity_dt"] / 1e6) for i in range(3)]
        else:
            t_us = row["timestamp"]
            w = [row[f"gyro_rad[{i}]"] for i in range(3)]
            f = [row[f"accelerometer_m_s2[{i}]"] for i in range(3)]
            if row["accelerometer_timestamp_relative"] == 0x7FFFFFFF:
                f = [math.nan] * 3
        assert same(got["t_s"], t_us / 1e6, 1e-12)
        for column, want in zip(["gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2"], w + f):
            assert same(got[column], want, 1e-12), (column, got, row)
    # At rest or in level flight the specific force points up: about -g along the axis that points down.
    mean = sum(r["az_m_s2"] for r in have) / len(have)
    assert -12.0 < mean < -7.0, mean
    return len(have)


def check_gps(truth, report, out):
    if "gps" not in report["files"]:
        assert not any(truth.get(key, ((), ()))[1] for key in truth if key[0] in ("vehicle_gps_position", "sensor_gps"))
        return 0
    topic, multi = report["files"]["gps"]["from"].split(":")
    rows = by_arrival(truth[(topic, int(multi))][1])
    have = table(os.path.join(out, "gps.csv"))
    assert len(have) == len(rows)
    code = {2: 5, 3: 5, 4: 4, 5: 2, 6: 1}
    for got, row in zip(have, rows):
        old = "lat" in row
        want = {
            "t_s": valid_us(row) / 1e6,
            "lat_deg": row["lat"] / 1e7 if old else row["latitude_deg"],
            "lon_deg": row["lon"] / 1e7 if old else row["longitude_deg"],
            "alt_m": row["alt_ellipsoid"] / 1e3 if old else row["altitude_ellipsoid_m"],
            "sigma_n_m": row["eph"], "sigma_e_m": row["eph"], "sigma_d_m": row["epv"],
            "vn_m_s": row["vel_n_m_s"], "ve_m_s": row["vel_e_m_s"], "vd_m_s": row["vel_d_m_s"],
            "fix": code.get(int(row["fix_type"]), 0), "satellites": row["satellites_used"],
            "sigma_vn_m_s": row["s_variance_m_s"] or math.nan,
        }
        for column, value in want.items():
            # Degrees go through radians: their rounding, a nanometre on the ground.
            assert same(got[column], value, 1e-14 if column.startswith("l") else 1e-12), (column, got[column], value)
    return len(have)


def check_air(truth, report, out):
    count = 0
    have = table(os.path.join(out, "airspeed.csv"))
    if "airspeed" in report["files"] and "from" in report["files"]["airspeed"]:
        topic, multi = report["files"]["airspeed"]["from"].split(":")
        rows = by_arrival(truth[(topic, int(multi))][1])
        assert len(have) == len(rows)
        for got, row in zip(have, rows):
            assert same(got["t_s"], valid_us(row) / 1e6, 1e-12)
            assert same(got["airspeed_m_s"], row["indicated_airspeed_m_s"])
            assert same(got["true_airspeed_m_s"], row["true_airspeed_m_s"])
            count += 1
    baro = table(os.path.join(out, "baro.csv"))
    topic, multi = report["files"]["baro"]["from"].split(":")
    rows = truth[(topic, int(multi))][1]
    if topic == "vehicle_air_data":
        assert len(baro) == len(rows)
        for got, row in zip(baro, sorted(rows, key=valid_us)):
            assert same(got["t_s"], valid_us(row) / 1e6, 1e-12)
            assert same(got["pressure_Pa"], row["baro_pressure_pa"])
            assert same(got["altitude_m"], row["baro_alt_meter"])
            assert same(got["temperature_degC"], row["baro_temp_celcius"])
            count += 1
    else:
        want = {row["timestamp"] + row["baro_timestamp_relative"]: row["baro_alt_meter"] for row in rows
                if row["baro_timestamp_relative"] != 0x7FFFFFFF}
        assert len(baro) == len(want)
        for got, (t_us, altitude) in zip(baro, sorted(want.items())):
            assert same(got["t_s"], t_us / 1e6, 1e-12) and same(got["altitude_m"], altitude)
            count += 1
    # Each altitude that the data set carries is one of the barometer's, and none is carried twice in a row.
    altitudes = {row["altitude_m"] for row in baro}
    carried = [row["baro_alt_m"] for row in have if not math.isnan(row["baro_alt_m"])]
    assert carried and all(value in altitudes for value in carried)
    return count


def check_mag(truth, report, out):
    topic, multi = report["files"]["mag"]["from"].split(":")
    rows = truth[(topic, int(multi))][1]
    if topic == "sensor_combined":
        rows = list({r["timestamp"] + r["magnetometer_timestamp_relative"]: r for r in reversed(rows)
                     if r["magnetometer_timestamp_relative"] != 0x7FFFFFFF}.items())
        rows = [dict(row, timestamp=t_us) for t_us, row in rows]
    have = table(os.path.join(out, "mag.csv"))
    assert len(have) == len(rows), (len(have), len(rows))
    for got, row in zip(have, sorted(rows, key=valid_us)):
        assert same(got["t_s"], valid_us(row) / 1e6, 1e-12)
        for i, column in enumerate(["mx_T", "my_T", "mz_T"]):
            assert same(got[column] * 1e4, row[f"magnetometer_ga[{i}]"], 1e-12)
    return len(have)


def whole(fathom, path, folder):
    blob = open(path, "rb").read()
    truth = decode(blob)
    out = os.path.join(folder, "whole")
    report = run(fathom, path, out)
    assert report["lost"]["count"] == 0, report["lost"]
    fields = check_sources(truth, out)
    rows = (check_imu(truth, report, out), check_gps(truth, report, out), check_air(truth, report, out),
            check_mag(truth, report, out))
    for topic, count in report["messages"].items():
        assert count == sum(len(r) for (name, _), (_, r) in truth.items() if name == topic), topic
    # The same units chosen by hand.
    for topic, file in (("vehicle_imu", "imu"), ("sensor_combined", "imu"), ("sensor_gps", "gps")):
        for (name, multi), (_, these) in truth.items():
            if name != topic or not these:
                continue
            report = run(fathom, path, out, "--from", f"{file}={topic}:{multi}")
            (check_imu if file == "imu" else check_gps)(truth, report, out)
    says_what_it_removes(fathom, path, out)
    return fields, rows


def says_what_it_removes(fathom, path, out):
    for name in ("usbl.csv", os.path.join("sources", "another.0.csv"), "notes.csv"):
        open(os.path.join(out, name), "w").write("t_s\n")
    done = subprocess.run([fathom, "import", path, "--out", out], capture_output=True, text=True)
    assert done.returncode == 0
    assert f"fathom: {out}: sources/another.0.csv, usbl.csv: removed, " in done.stderr, done.stderr
    assert os.path.exists(os.path.join(out, "notes.csv"))


def damaged(fathom, path, folder, seed):
    """Cut anywhere: what stands before the cut comes out, all of it. Garbage put in: all but its surroundings."""
    blob = open(path, "rb").read()
    rng = random.Random(seed)
    out = os.path.join(folder, "cut")
    file = os.path.join(folder, "cut.ulg")
    for _ in range(12):
        part = blob[:rng.randrange(len(blob) // 10, len(blob))]
        open(file, "wb").write(part)
        run(fathom, file, out)
        check_sources(decode(part), out)
    truth = decode(blob)
    data = len(blob) // 2
    for _ in range(6):
        at = rng.randrange(data, len(blob) - 4000)
        bad = bytearray(blob)
        length = rng.randrange(1, 3000)
        bad[at:at + length] = rng.randbytes(length)
        open(file, "wb").write(bad)
        report = run(fathom, file, out)
        lost = 0
        for (topic, multi), (columns, rows) in truth.items():
            if topic not in KINDS or not rows:
                continue
            have = {row["timestamp"]: row for row in table(os.path.join(out, "sources", f"{topic}.{multi}.csv"))}
            missing = [row for row in rows if row["timestamp"] not in have]
            lost += len(missing)
        # A message is 20 bytes at least; one on either side of the garbage may be half.
        assert lost <= length / 20 + 2, (at, length, lost)
        # Inside one message nothing tells garbage: there is no checksum.
        assert lost < 2 or report["lost"]["count"] > 0


def refused(fathom, path, folder):
    blob = bytearray(open(path, "rb").read())
    file = os.path.join(folder, "refused.ulg")
    out = os.path.join(folder, "refused")

    def refusal(content):
        open(file, "wb").write(content)
        done = subprocess.run([fathom, "import", file, "--out", out], capture_output=True, text=True)
        assert done.returncode != 0 and done.stderr.startswith("fathom: "), (done.returncode, done.stderr)
        assert len(done.stderr.strip().splitlines()) == 1
        return done.stderr

    size, kind = struct.unpack_from("<HB", blob, 16)
    if kind == ord("B"):
        unknown = bytearray(blob)
        unknown[16 + 3 + 8] |= 2
        assert "incompatible" in refusal(unknown)
        unknown = bytearray(blob)
        unknown[16 + 3 + 8 + 5] = 1
        assert "offset 32" in refusal(unknown)
    refusal(b"")
    refusal(blob[:15])
    refusal(b"\0" + blob[1:])


def main():
    fathom, logs = sys.argv[1:3]
    names = sorted(n for n in os.listdir(logs) if n.endswith(".ulg")) if os.path.isdir(logs) else []
    if not names:
        print("no logs in", logs)
        sys.exit(1 if os.environ.get("FATHOM_REQUIRE_DATA") == "1" else 77)
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(logs, name)
            fields, rows = whole(fathom, path, folder)
            damaged(fathom, path, folder, 20260)
            refused(fathom, path, folder)
            print(f"{name}: {fields} fields as decoded, rows of imu, gps, air, mag: {rows}")


main()
