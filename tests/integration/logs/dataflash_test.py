#!/usr/bin/env python3
"""`fathom import` of ArduPilot logs that this test writes itself, after the public format: what went in comes
out, over garbage and cuts. Usage: dataflash_test.py FATHOM"""
import csv
import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

CODES = {"b": "b", "B": "B", "h": "h", "H": "H", "i": "i", "I": "I", "f": "f", "d": "d", "n": "4s", "N": "16s",
         "Z": "64s", "c": "h", "C": "H", "e": "i", "E": "I", "L": "i", "M": "B", "q": "q", "Q": "Q"}
START_UTC_MS = 1_700_000_000_000  # of the autopilot's zero


class Log:
    def __init__(self, described=True):
        self.parts = []     # (bytes, name, values)
        self.types = {}
        self.described = described
        self.define("FMT", "BBnNZ", "Type,Length,Name,Format,Columns", number=128)
        if described:
            self.define("UNIT", "QbZ", "TimeUS,Id,Label")
            self.define("MULT", "Qbd", "TimeUS,Id,Mult")
            self.define("FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds")
            for unit, label in (("s", "s"), ("E", "rad/s"), ("o", "m/s/s"), ("G", "Gauss"), ("#", "instance")):
                self.add("UNIT", 0, ord(unit), label.encode())
            for letter, factor in (("F", 1e-6), ("C", 1e-3), ("B", 1e-2), ("G", 1e-7), ("0", 1.0), ("-", 0.0)):
                self.add("MULT", 0, ord(letter), factor)

    def define(self, name, letters, labels, units=None, mults=None, number=None):
        number = number or 129 + len(self.types)
        code = "<" + "".join(CODES[c] for c in letters)
        self.types[name] = (number, code)
        self.add("FMT", number, 3 + struct.calcsize(code), name.encode(), letters.encode(), labels.encode())
        if units and self.described:
            self.add("FMTU", 0, number, units.encode(), mults.encode())

    def add(self, name, *values):
        number, code = self.types[name]
        self.parts.append((b"\xa3\x95" + bytes([number]) + struct.pack(code, *values), name, values))

    def bytes(self, between=lambda i: b""):
        return b"".join(between(i) + part for i, (part, _, _) in enumerate(self.parts))


def f32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def modern(rng, firmware="ArduPlane V4.5.1 (abcd)", parameters=()):
    log = Log()
    log.define("MSG", "QZ", "TimeUS,Message", "s-", "F-")
    log.define("PARM", "QNff", "TimeUS,Name,Value,Default", "s---", "F---")
    log.define("IMU", "QBffffffIIfBBHH", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz",
               "s#EEEooo--O--zz", "F-000000-----00")
    log.define("GPS", "QBBIHBcLLeffffB", "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U",
               "s#-s-S-DUmnhnh-", "F--C-0BGGB000--")
    log.define("GPA", "QBCCCCfBIHeHH", "TimeUS,I,VDop,HAcc,VAcc,SAcc,YAcc,VV,SMS,Delta,AEl,RTCMFU,RTCMFD",
               "s#-mmnd-ssm--", "F-BBBB0-CCB--")
    log.define("ARSP", "QBffcffBBffB", "TimeUS,I,Airspeed,DiffPress,Temp,RawPress,Offset,U,H,Hp,TR,Pri",
               "s#nPOPP-----", "F-00B00-----")
    log.define("BARO", "QBffcfIffB", "TimeUS,I,Alt,Press,Temp,CRt,SMS,Offset,GndTemp,Health", "s#mPOnsmO-",
               "F-00B0C?0-")
    log.define("MAG", "QBhhhhhhhhhBI", "TimeUS,I,MagX,MagY,MagZ,OfsX,OfsY,OfsZ,MOX,MOY,MOZ,Health,S",
               "s#GGGGGGGGG-s", "F-CCCCCCCCC-F")
    log.define("XYZW", "QBf", "TimeUS,I,Odd", "s#-", "F-0")
    log.add("MSG", 0, firmware.encode())
    for name, value in parameters:
        log.add("PARM", 0, name.encode(), value, 0.0)
    gps0_ms = START_UTC_MS + 18_000 - 315_964_800_000  # GPS time counts no leap seconds
    for k in range(300):
        us = 5_000_000 + 10_000 * k
        for i in range(3):
            w = [rng.gauss(0, 0.1) for _ in range(3)]
            f = [rng.gauss(0, 0.5), rng.gauss(0, 0.5), rng.gauss(-9.8, 0.5)]
            log.add("IMU", us + i, i, *w, *f, 0, 0, 40.0, 1, 1, 1000, 1000)
        log.add("XYZW", us, 0, 1.0)
        if k % 20 == 0:
            ms = gps0_ms + us // 1000
            for i in range(2):
                log.add("GPS", us + 5, i, 3 + 3 * i, ms % 604_800_000, ms // 604_800_000, 12, 85,
                        -351_332_423 + 17 * k, 1_491_652_374 - k, 58_433 + k, f32(10 + rng.random()),
                        f32(rng.uniform(0, 360)), f32(-0.5), f32(123.0) if i else 0.0, 1 - i)
                log.add("GPA", us + 5, i, 120, 150 + k, 0 if i else 250, 30, 2.5 if i else 0.0, i, us // 1000, 200,
                        -(1 << 31) if i else 60_433 + k, 0, 0)
        if k % 10 == 0:
            log.add("ARSP", us + 7, 0, f32(15 + rng.random()), 140.0, 2512, 141.0, 1.0, 1, 1, 1.0, 0.0, 0)
        if k % 8 == 0:
            for i in range(2):
                log.add("BARO", us + 3, i, f32(1.0 + 0.01 * k - 7 * i), f32(101000.0 - k + 9000 * i), 2500 + k,
                        0.0, us // 1000, 0.0, 25.0, 1)
            log.add("MAG", us + 4, 0, -235 + k, 12, 431, 0, 0, 0, 0, 0, 0, 1, us & 0xFFFFFFFF)
    return log


def table(out, name):
    path = os.path.join(out, name + ".csv")
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(file)]


def run(fathom, blob, folder, *more, code=0):
    file, out = os.path.join(folder, "log.bin"), os.path.join(folder, "out")
    open(file, "wb").write(blob)
    done = subprocess.run([fathom, "import", file, "--out", out, *more], capture_output=True, text=True)
    assert done.returncode == code, (done.returncode, done.stderr)
    if code:
        return done.stderr, out
    return json.load(open(os.path.join(out, "import.json"))), out


def near(a, b, tolerance=1e-9):
    return (math.isnan(a) and math.isnan(b)) or abs(a - b) <= tolerance * max(1.0, abs(b))


def rows_of(log, name, instance=None):
    return [v for _, n, v in log.parts if n == name and (instance is None or v[1] == instance)]


def check_whole(fathom, folder, log):
    report, out = run(fathom, log.bytes(), folder)
    assert report["lost"]["count"] == 0, report["lost"]
    assert report["info"]["firmware"].startswith("ArduPlane")
    # The messages are logged 5 us behind the millisecond that they name.
    assert report["utc_of_start"] == "2023-11-14T22:13:19.999995Z", report["utc_of_start"]
    imu, want = table(out, "imu"), rows_of(log, "IMU", 0)
    assert len(imu) == len(want) == 300
    for got, row in zip(imu, want):
        assert near(got["t_s"], row[0] / 1e6)
        for column, value in zip(["gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2"], row[2:8]):
            assert got[column] == f32(value)
    gps, want = table(out, "gps"), rows_of(log, "GPS", 0)
    accuracy = rows_of(log, "GPA", 0)
    assert len(gps) == len(want) == 15
    for got, row, quality in zip(gps, want, accuracy):
        assert near(got["lat_deg"], row[7] / 1e7, 1e-14) and near(got["lon_deg"], row[8] / 1e7, 1e-14)
        assert near(got["alt_m"], quality[10] / 100) and got["fix"] == 5 and got["satellites"] == 12
        course = math.radians(row[11])
        assert near(got["vn_m_s"], row[10] * math.cos(course)) and near(got["ve_m_s"], row[10] * math.sin(course))
        assert math.isnan(got["vd_m_s"])  # VV says that there is none
        assert near(got["sigma_n_m"], quality[3] / 100) and near(got["sigma_d_m"], quality[4] / 100)
        assert near(got["sigma_vn_m_s"], 0.3)
    # Altitudes of the standard atmosphere: BARO's own begin at zero.
    baro, want = table(out, "baro"), rows_of(log, "BARO", 0)
    assert len(baro) == len(want)
    for got, row in zip(baro, want):
        assert got["pressure_Pa"] == row[3] and near(got["temperature_degC"], row[4] / 100)
        assert near(got["altitude_m"], 44330.77 * (1 - (row[3] / 101325) ** 0.190263), 1e-4)
    air = table(out, "airspeed")
    assert [row["airspeed_m_s"] for row in air] == [row[2] for row in rows_of(log, "ARSP")]
    mag, want = table(out, "mag"), rows_of(log, "MAG")
    assert len(mag) == len(want)
    for got, row in zip(mag, want):
        for column, value in zip(["mx_T", "my_T", "mz_T"], row[2:5]):
            assert near(got[column], value * 1e-7, 1e-15)
    # The others, by choice.
    _, out = run(fathom, log.bytes(), folder, "--from", "imu=IMU:2", "--from", "gps=GPS:1")
    assert [row["gx_rad_s"] for row in table(out, "imu")] == [f32(row[2]) for row in rows_of(log, "IMU", 2)]
    gps, want = table(out, "gps"), rows_of(log, "GPS", 1)
    for got, row in zip(gps, want):
        assert got["fix"] == 1 and near(got["alt_m"], row[9] / 100) and got["vd_m_s"] == row[12]
        assert math.isnan(got["sigma_d_m"])  # zero is no accuracy
    heading = table(out, "heading")
    assert len(heading) == len(want) and all(near(h["heading_deg"], 123.0) and near(h["sigma_deg"], 2.5)
                                             for h in heading)
    # Every message of the kinds, by instance, with the log's own names.
    for i in range(3):
        have = table(os.path.join(out, "sources"), f"IMU.{i}")
        assert [row["AccZ"] for row in have] == [f32(row[7]) for row in rows_of(log, "IMU", i)]
    assert not os.path.exists(os.path.join(out, "sources", "XYZW.0.csv")) and report["messages"]["XYZW"] == 300
    report, out = run(fathom, log.bytes(), folder, "--time", "utc")
    assert near(table(out, "imu")[0]["t_s"], START_UTC_MS / 1e3 - 1577836800 + 5.0 - 5e-6, 1e-12)


def check_damage(fathom, folder, log, rng):
    definitions = next(i for i, (_, name, _) in enumerate(log.parts) if name == "IMU")
    garbage = {}

    def between(i):
        if i < definitions or rng.random() > 0.05:
            return b""
        garbage[i] = rng.randbytes(rng.randrange(1, 400))
        return garbage[i]

    report, out = run(fathom, log.bytes(between), folder)
    for i in range(3):
        have = table(os.path.join(out, "sources"), f"IMU.{i}")
        assert len(have) == 300, (i, len(have))
    assert report["lost"]["bytes"] == sum(map(len, garbage.values())), report["lost"]["bytes"]
    # A cut anywhere.
    blob = log.bytes()
    for _ in range(20):
        cut = rng.randrange(len(blob) // 5, len(blob))
        _, out = run(fathom, blob[:cut], folder)
        at, want = 0, 0
        for part, name, values in log.parts:
            at += len(part)
            want += at <= cut and name == "IMU" and values[1] == 1
        assert len(table(os.path.join(out, "sources"), "IMU.1")) == want
    # Bytes that are missing inside messages.
    bad = bytearray(blob)
    for _ in range(10):
        at = rng.randrange(len(bad) // 2, len(bad) - 100)
        del bad[at:at + rng.randrange(1, 20)]
    report, out = run(fathom, bytes(bad), folder)
    assert sum(len(table(os.path.join(out, "sources"), f"IMU.{i}")) for i in range(3)) >= 900 - 20
    assert report["lost"]["count"] > 0
    # Anything, without a crash.
    for _ in range(40):
        bad = bytearray(blob)
        for _ in range(rng.randrange(1, 200)):
            bad[rng.randrange(len(bad))] = rng.randrange(256)
        open(os.path.join(folder, "log.bin"), "wb").write(bad)
        done = subprocess.run([fathom, "import", os.path.join(folder, "log.bin"), "--out",
                               os.path.join(folder, "out")], capture_output=True, text=True)
        assert 0 <= done.returncode < 64, done
    for nothing in (b"", b"\xa3\x95", rng.randbytes(5000), log.parts[0][0]):
        message, _ = run(fathom, nothing, folder, code=3)
        assert message.startswith("fathom: ") and ("expected" in message or "neither" in message), message


def check_early(fathom, folder, rng):
    """2014: no units, no instances, times in milliseconds, hundredths implied."""
    log = Log(described=False)
    log.define("IMU", "Iffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ")
    log.define("IMU2", "Iffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ")
    log.define("GPS", "BIHBcLLeeEefI", "Status,TimeMS,Week,NSats,HDop,Lat,Lng,RelAlt,Alt,Spd,GCrs,VZ,T")
    log.define("MAG", "Ihhhhhhhhh", "TimeMS,MagX,MagY,MagZ,OfsX,OfsY,OfsZ,MOfsX,MOfsY,MOfsZ")
    for k in range(100):
        ms = 3000 + 20 * k
        log.add("IMU", ms, *(rng.gauss(0, 1) for _ in range(6)))
        log.add("IMU2", ms, *(rng.gauss(0, 1) for _ in range(6)))
        if k % 10 == 0:
            log.add("GPS", 3, 200_000_000 + ms, 1800, 9, 150, 473_977_422, 85_455_940, 1000, 48_800, 1234, 9000,
                    -1.5, ms)
            log.add("MAG", ms, 100, -200, 400, 0, 0, 0, 0, 0, 0)
    report, out = run(fathom, log.bytes(), folder)
    assert report["files"]["imu"]["others"] == ["IMU:1"]
    imu = table(out, "imu")
    assert [row["gx_rad_s"] for row in imu] == [f32(row[1]) for row in rows_of(log, "IMU")]
    assert near(imu[3]["t_s"], 3.06)
    for got in table(out, "gps"):
        assert near(got["lat_deg"], 47.3977422) and near(got["alt_m"], 488.0)
        assert near(got["vn_m_s"], 0.0, 1e-9) and near(got["ve_m_s"], 12.34) and near(got["vd_m_s"], -1.5)
    assert near(table(out, "gps")[0]["t_s"], 3.0)
    assert near(table(out, "mag")[0]["mz_T"], 400e-7, 1e-15)
    assert report["utc_of_start"].startswith("2014-07-08T07:33:04"), report["utc_of_start"]
    assert any("mean sea level" in note for note in report["notes"])


def check_submarine(fathom, folder, rng):
    log = modern(rng, "ArduSub V4.1.2 (abcd)", [("BARO_PRIMARY", 1.0)])
    report, out = run(fathom, log.bytes(), folder)
    depth, want = table(out, "depth"), rows_of(log, "BARO", 1)
    assert report["files"]["depth"]["from"] == "BARO:1" and len(depth) == len(want)
    for got, row in zip(depth, want):
        assert got["depth_m"] == -row[2]


def main():
    fathom = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        rng = random.Random(7)
        log = modern(rng)
        check_whole(fathom, folder, log)
        check_damage(fathom, folder, log, rng)
        check_early(fathom, folder, rng)
        check_submarine(fathom, folder, rng)
    print("DataFlash: what went in came out")


main()
