#!/usr/bin/env python3
"""`fathom export` read back by parsers that are not ours. Usage: export_test.py FATHOM"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

# The order of the elements of a trkpt in the schema of GPX 1.1.
GPX_ORDER = ["ele", "time", "magvar", "geoidheight", "name", "cmt", "desc", "src", "link", "sym", "type", "fix",
             "sat", "hdop", "vdop", "pdop", "ageofdgpsdata", "dgpsid", "extensions"]
EPOCH = "2026-01-31T23:59:58Z"


def run(*arguments, code=0):
    done = subprocess.run(arguments, capture_output=True, text=True)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    return done.stderr


def write_nav(path):
    """Around the antimeridian, with a gap and with a row that knows no position."""
    rows = []
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow("t_s lat_deg lon_deg alt_m vn_m_s ve_m_s vd_m_s roll_deg pitch_deg yaw_deg sigma_n_m sigma_e_m "
                     "sigma_d_m sigma_vn_m_s sigma_ve_m_s sigma_vd_m_s sigma_roll_deg sigma_pitch_deg sigma_yaw_deg "
                     "mode gps_outage_s alignment".split())
        for k in range(200):
            t = k * 0.1 + (100 if k >= 150 else 0)
            lon = 179.999503 + k * 1e-5
            row = [f"{t:.1f}", -17.5 + k * 1e-5, lon - 360 if lon > 180 else lon, -20 - 0.1 * k, 1, 2, 0.1, 1, 2,
                   -10.25, 1, 2, 3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.5, "gps_aided" if k < 100 else "dead_reckoning",
                   0, "aligned"]
            if k == 55:
                row[1] = row[2] = ""
            else:
                rows.append(row)
            out.writerow(row)
    return rows


def check_gpx(path, rows):
    root = xml.parse(path).getroot()
    ns = "{http://www.topografix.com/GPX/1/1}"
    assert root.tag == ns + "gpx" and root.attrib["version"] == "1.1" and "creator" in root.attrib
    assert [child.tag for child in root] == [ns + "metadata", ns + "trk"]
    assert len(root.findall(f"{ns}trk/{ns}trkseg")) == 2  # the gap
    points = root.findall(f"{ns}trk/{ns}trkseg/{ns}trkpt")
    assert len(points) == len(rows)
    for point, row in zip(points, rows):
        assert math.isclose(float(point.attrib["lat"]), row[1], abs_tol=1e-9)
        assert -180 <= float(point.attrib["lon"]) < 180
        assert abs((float(point.attrib["lon"]) - row[2] + 180) % 360 - 180) < 1.1e-9
        order = [GPX_ORDER.index(child.tag[len(ns):]) for child in point]
        assert order == sorted(order)
        assert math.isclose(float(point.find(ns + "ele").text), row[3], abs_tol=1e-3)
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", point.find(ns + "time").text)
    assert points[0].find(ns + "time").text == "2026-01-31T23:59:58.000Z"
    assert points[30].find(ns + "time").text == "2026-02-01T00:00:01.000Z"
    assert points[0].find(ns + "fix").text == "3d" and points[-1].find(ns + "fix") is None


def check_kml(path, rows):
    root = xml.parse(path).getroot()
    ns = "{http://www.opengis.net/kml/2.2}"
    assert root.tag == ns + "kml"
    lines = [p.find(f"{ns}LineString/{ns}coordinates").text.split() for p in root.iter(ns + "Placemark")
             if p.find(ns + "LineString") is not None]
    assert len(lines) == 3  # the antimeridian and the gap
    for text, row in zip([t for t in sum(lines, []) if abs(float(t.split(",")[0])) != 180], rows):
        lon, lat, alt = map(float, text.split(","))
        assert math.isclose(lon, row[2], abs_tol=1e-9) and math.isclose(lat, row[1], abs_tol=1e-9)
        assert math.isclose(alt, row[3], abs_tol=1e-3)
    styles = {style.attrib["id"] for style in root.iter(ns + "Style")}
    assert all(url.text[1:] in styles for url in root.iter(ns + "styleUrl"))


def check_geojson(path, rows):
    data = json.load(open(path))
    assert data["type"] == "FeatureCollection" and len(data["features"]) == 1
    feature = data["features"][0]
    assert feature["type"] == "Feature" and set(feature) == {"type", "properties", "geometry"}
    geometry = feature["geometry"]
    assert geometry["type"] == "MultiLineString"
    lines = geometry["coordinates"]
    assert len(lines) == 3  # the antimeridian and the gap
    assert lines[0][-1][0] == 180.0 and lines[1][0][0] == -180.0
    for line in lines:
        assert len(line) >= 2
        for a, b in zip(line, line[1:]):
            assert abs(a[0] - b[0]) < 180 and abs(a[1]) <= 90 and abs(a[0]) <= 180
    assert sum(map(len, lines)) == len(rows) + 2


def check_nmea(path, rows):
    text = open(path, "rb").read().decode("ascii")
    gga = 0
    for line in text.split("\r\n")[:-1]:
        assert len(line) + 2 <= 82 and line[0] == "$"
        body, check = line[1:].split("*")
        total = 0
        for c in body:
            total ^= ord(c)
        assert f"{total:02X}" == check
        fields = body.split(",")
        if fields[0] == "INGGA":
            row = rows[gga]
            gga += 1
            lat = (int(fields[2][:2]) + float(fields[2][2:]) / 60) * (-1 if fields[3] == "S" else 1)
            lon = (int(fields[4][:3]) + float(fields[4][3:]) / 60) * (-1 if fields[5] == "W" else 1)
            assert math.isclose(lat, row[1], abs_tol=1e-7) and math.isclose(lon, row[2], abs_tol=1e-7)
            assert math.isclose(float(fields[9]) + float(fields[11]), row[3], abs_tol=0.011)
            assert fields[6] == ("1" if row[-3] == "gps_aided" else "6")
            assert len(fields) == 15
        if fields[0] == "INHDT":
            assert fields[1] == "349.75"
        if fields[0] == "INRMC":
            assert len(fields) == 13 and fields[9] in ("310126", "010226")
    assert gga == len(rows)


def main():
    fathom = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        nav = os.path.join(folder, "nav.csv")
        rows = write_nav(nav)
        for kind, check in (("gpx", check_gpx), ("kml", check_kml), ("geojson", check_geojson), ("nmea", check_nmea)):
            out = os.path.join(folder, "out." + kind)
            run(fathom, "export", nav, "--format", kind, "--out", out, "--rate", "0", "--epoch", EPOCH)
            check(out, rows)
        # Our own decoder takes what we write.
        done = subprocess.run([fathom, "decode", "nmea", os.path.join(folder, "out.nmea"), "--json"],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        # One point a second unless asked.
        out = os.path.join(folder, "thin.gpx")
        run(fathom, "export", nav, "--format", "gpx", "--out", out)
        assert 18 <= open(out).read().count("<trkpt") <= 22
        out = os.path.join(folder, "csv")
        run(fathom, "export", nav, "--format", "csv", "--out", out, "--epoch", EPOCH)
        copy = list(csv.DictReader(open(os.path.join(out, "nav.csv"))))
        assert copy[1]["utc"] == "2026-01-31T23:59:58.100000Z" and copy[1]["lat_deg"] == str(-17.5 + 1e-5)
        # A data set.
        data = os.path.join(folder, "data")
        run(fathom, "simulate", "survey", "--out", data, "--duration", "120")
        out = os.path.join(folder, "data.kml")
        run(fathom, "export", data, "--format", "kml", "--out", out)
        names = [f.find("{http://www.opengis.net/kml/2.2}name").text
                 for f in xml.parse(out).getroot().iter("{http://www.opengis.net/kml/2.2}Folder")]
        assert "gps" in names and "reference" in names, names
        run(fathom, "export", data, "--format", "csv", "--out", os.path.join(folder, "again"))
        assert open(os.path.join(data, "imu.csv")).read() == open(os.path.join(folder, "again", "imu.csv")).read()
        # Its instant goes with it; where nobody says one none is made up.
        assert not os.path.exists(os.path.join(folder, "again", "import.json"))
        run(fathom, "export", data, "--format", "csv", "--out", os.path.join(folder, "dated"), "--epoch", EPOCH)
        run(fathom, "export", os.path.join(folder, "dated"), "--format", "csv", "--out", os.path.join(folder, "copy"))
        said = json.load(open(os.path.join(folder, "copy", "import.json")))["utc_of_start"]
        assert said.startswith(EPOCH[:-1]), said
        # What cannot be is said.
        for bad, code in (((nav, "--format", "gpx", "--out", "/nowhere/x"), 4),
                          ((nav, "--format", "gpx", "--out", out, "--epoch", "yesterday"), 2),
                          ((os.path.join(folder, "none.csv"), "--format", "gpx", "--out", out), 3),
                          ((nav, "--format", "gpx", "--out", out, "--track", "gps"), 3)):
            said = run(fathom, "export", *bad, code=code)
            assert said.startswith("fathom: ") and len(said.splitlines()) == 1, said
    print("export: gpx, kml, geojson, nmea and csv read back")


main()
