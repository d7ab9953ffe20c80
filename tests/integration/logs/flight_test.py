#!/usr/bin/env python3
"""A simulated flight, written as the log that PX4 would have made of it, imported, solved: the same flight comes
out. Usage: flight_test.py FATHOM CONFIG"""
import csv
import json
import os
import struct
import subprocess
import sys
import tempfile

FORMATS = {
    "sensor_combined": "uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;"
                       "int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;"
                       "uint32_t accelerometer_integral_dt;uint8_t accelerometer_clipping;uint8_t[3] _padding0;",
    "sensor_gps": "uint64_t timestamp;uint64_t timestamp_sample;double latitude_deg;double longitude_deg;"
                  "double altitude_msl_m;double altitude_ellipsoid_m;float s_variance_m_s;float eph;float epv;"
                  "float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;bool vel_ned_valid;"
                  "uint8_t satellites_used;uint8_t[5] _padding0;",
    "airspeed": "uint64_t timestamp;uint64_t timestamp_sample;float indicated_airspeed_m_s;float true_airspeed_m_s;"
                "float air_temperature_celsius;float confidence;",
}


def rows(folder, name):
    with open(os.path.join(folder, name + ".csv"), newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    return float(text) if text else float("nan")


def us(text):
    return round(float(text) * 1e6) + 1_000_000  # the autopilot had been on for a second


def received(row):
    return max(us(row["t_s"]), us(row.get("t_received_s") or row["t_s"]))


def message(kind, payload):
    return struct.pack("<HB", len(payload), ord(kind)) + payload


def ulog(folder):
    out = [b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0), message("B", bytes(40))]
    for name, fields in FORMATS.items():
        out.append(message("F", f"{name}:{fields}".encode()))
    for i, name in enumerate(FORMATS):
        out.append(message("A", struct.pack("<BH", 0, i) + name.encode()))
    data = []
    for row in rows(folder, "imu"):
        values = [number(row[c]) for c in ("gx_rad_s", "gy_rad_s", "gz_rad_s")]
        force = [number(row[c]) for c in ("ax_m_s2", "ay_m_s2", "az_m_s2")]
        t = us(row["t_s"])
        data.append((t, struct.pack("<HQ3fIi3fIB", 0, t, *values, 10000, 0, *force, 10000, 0)))
    for row in rows(folder, "gps"):
        place = [number(row[c]) for c in ("lat_deg", "lon_deg")]
        altitude = number(row["alt_m"])
        rest = [number(row[c]) for c in ("sigma_vn_m_s", "sigma_n_m", "sigma_d_m", "vn_m_s", "ve_m_s", "vd_m_s")]
        t = received(row)
        data.append((t, struct.pack("<HQQ4d6f3B", 1, t, us(row["t_s"]), *place, altitude + 30, altitude, *rest,
                                    3 if row["fix"] == "5" else 0, 1, 11)))
    for row in rows(folder, "airspeed"):
        t = received(row)
        data.append((t, struct.pack("<HQQ4f", 2, t, us(row["t_s"]), number(row["airspeed_m_s"]),
                                    number(row["true_airspeed_m_s"]), 15.0, 1.0)))
    data.sort(key=lambda one: one[0])
    out += [message("D", payload) for _, payload in data]
    return b"".join(out)


def run(*arguments):
    done = subprocess.run(arguments, capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.returncode, done.stderr)


def main():
    fathom, config = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        flown, log = os.path.join(folder, "flown"), os.path.join(folder, "flown.ulg")
        imported, metrics = os.path.join(folder, "imported"), os.path.join(folder, "metrics.json")
        run(fathom, "simulate", "flight", "--out", flown, "--duration", "180", "--seed", "3")
        open(log, "wb").write(ulog(flown))
        run(fathom, "import", log, "--out", imported)
        # The truth, on the autopilot's clock, is what the solution of the log is held against.
        truth = rows(flown, "reference")
        with open(os.path.join(imported, "reference.csv"), "w", newline="") as file:
            out = csv.DictWriter(file, truth[0].keys())
            out.writeheader()
            out.writerows(dict(row, t_s=f"{float(row['t_s']) + 1:.6f}") for row in truth)
        errors = {}
        for name, data in (("flown", flown), ("imported", imported)):
            run(fathom, "solve", data, "--config", config, "--out", os.path.join(folder, "nav.csv"), "--metrics",
                metrics)
            errors[name] = json.load(open(metrics))["horizontal_error_m"]["rms"]
        print("horizontal error, rms:", errors)
        assert errors["flown"] < 10.0
        # Single precision and microseconds are all that differs; the barometer is not in this log.
        assert errors["imported"] < 1.5 * errors["flown"] + 0.3


main()
