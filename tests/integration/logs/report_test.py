#!/usr/bin/env python3
"""`fathom report` and `fathom plot`: the page is well formed, needs nothing from elsewhere, says what is wrong.
Usage: report_test.py FATHOM CONFIG"""
import csv
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from html.parser import HTMLParser

VOID = {"meta", "br", "rect", "line", "path", "ellipse"}


class Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.sections, self.plots, self.findings, self.text = [], [], 0, [], []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("src", "srcset", "data", "action"):
            assert name not in attributes, (tag, attributes)
        assert attributes.get("href", "#").startswith("#"), attributes
        assert tag not in ("script", "link", "iframe", "object", "img"), tag
        if tag == "section":
            self.sections.append(attributes["id"])
        if tag == "svg":
            self.plots += 1
        if tag == "li":
            self.findings.append("")
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        assert self.open and self.open[-1] == tag, (tag, self.open[-3:])
        self.open.pop()

    def handle_data(self, data):
        if "li" in self.open:
            self.findings[-1] += data
        self.text.append(data)


def run(*arguments, code=0):
    done = subprocess.run(arguments, capture_output=True, text=True)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    return done


def page(fathom, data, config, out, *more, code=0):
    said = run(fathom, "report", data, "--config", config, "--out", out, *more, code=code).stdout
    text = open(out).read()
    parsed = Page()
    parsed.feed(text)
    parsed.close()
    assert not parsed.open, parsed.open
    assert "nan" not in "".join(parsed.text).lower().split()
    # Each drawing is XML of its own.
    for part in text.split("<svg ")[1:]:
        xml.fromstring("<svg " + part[:part.index("</svg>")] + "</svg>")
    return parsed, said, text


def main():
    fathom, config = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        data, out = os.path.join(folder, "data"), os.path.join(folder, "page.html")
        run(fathom, "simulate", "survey", "--out", data, "--duration", "150", "--seed", "4")
        good, said, text = page(fathom, data, config, out)
        assert good.sections == ["verdict", "track", "errors", "nees", "sigmas", "innovations", "outages",
                                 "alignment"], good.sections
        assert good.plots >= 12, good.plots
        again = os.path.join(folder, "again.html")
        page(fathom, data, config, again)
        assert open(again).read() == text  # the same data, the same bytes
        assert len(text) < 3_000_000
        assert not any("wrong" == one.split()[0] for one in good.findings), good.findings

        # A compass that is mounted 25 degrees wrong, from the middle on: it is named.
        path = os.path.join(data, "heading.csv")
        rows = list(csv.DictReader(open(path)))
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            for row in rows:
                if float(row["t_s"]) > 75:
                    row["heading_deg"] = (float(row["heading_deg"]) + 25) % 360
                writer.writerow(row)
        bad, said, _ = page(fathom, data, config, out)
        assert "wrong" in bad.findings[0] and "heading" in bad.findings[0] and "rejected" in bad.findings[0], \
            bad.findings
        assert said.splitlines()[0] in " ".join(bad.findings[0].split())

        # Without a reference there are no errors to show, and the page is one nevertheless.
        os.remove(os.path.join(data, "reference.csv"))
        parsed, _, _ = page(fathom, data, config, out)
        assert "errors" not in parsed.sections and "nees" not in parsed.sections

        nav = os.path.join(folder, "nav.csv")
        run(fathom, "solve", data, "--config", config, "--out", nav, "--rate", "5")
        svg = os.path.join(folder, "plot.svg")
        for columns in (["sigma_n_m", "sigma_e_m", "--log"], ["track"], ["yaw_deg"]):
            run(fathom, "plot", nav, *columns, "--out", svg)
            root = xml.parse(svg).getroot()
            assert root.tag == "{http://www.w3.org/2000/svg}svg"
            assert any("curve" in (path.get("class") or "") and len(path.get("d")) > 100
                       for path in root.iter("{http://www.w3.org/2000/svg}path"))
        for bad, code in ((["nothing"], 3), (["mode"], 3)):
            said = run(fathom, "plot", nav, *bad, "--out", svg, code=code).stderr
            assert said.startswith("fathom: ") and len(said.splitlines()) == 1, said
        said = run(fathom, "report", folder, "--config", config, "--out", out, code=3).stderr
        assert "imu.csv" in said, said
    print("report: well formed, of itself, and it names what was wrong")


main()
