"""The SPDX document of a package with one executable: what it loads, what is compiled into it, the sources, and that it is
one document. Usage: run.py SOURCE BUILD EXECUTABLE"""

import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

source, build, executable = map(pathlib.Path, sys.argv[1:])
if not (source / ".git").exists() or not shutil.which("dpkg-deb"):
    print("skipped: needs a checkout and dpkg")
    sys.exit(77)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    root = folder / "root"
    (root / "DEBIAN").mkdir(parents=True)
    (root / "usr/bin").mkdir(parents=True)
    shutil.copy(executable, root / "usr/bin" / executable.name)
    (root / "DEBIAN/control").write_text("Package: fathom\nVersion: 1.2+x\nArchitecture: all\nMaintainer: nobody <nobody@localhost>\n"
                                         "Description: one executable\n")
    deb = folder / "fathom.deb"
    run("dpkg-deb", "-Znone", "--build", str(root), str(deb))
    made = [run(str(source / "deploy/packaging/sbom"), str(build), "1.2+x", "1000000000", str(deb)) for _ in range(2)]
    sum_of_deb = hashlib.sha256(deb.read_bytes()).hexdigest()

expect(made[0] == made[1], "the same twice")
document = json.loads(made[0])
expect(document["spdxVersion"] == "SPDX-2.3" and document["dataLicense"] == "CC0-1.0", "which document it is")
expect(document["creationInfo"]["created"] == "2001-09-09T01:46:40Z", "its time is the one given")

things = document["packages"] + document["files"]
identities = [thing["SPDXID"] for thing in things] + [document["SPDXID"]]
expect(len(set(identities)) == len(identities), "each has an identity of its own")
expect(all(re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", one) for one in identities), "identities as SPDX wants them")
known = set(identities)
for relation in document["relationships"]:
    expect({relation["spdxElementId"], relation["relatedSpdxElement"]} <= known, f"both ends of {relation}")
licences = {one["licenseId"] for one in document["hasExtractedLicensingInfos"]}
for package in document["packages"]:
    for name in package["licenseDeclared"].split(" AND "):
        expect(not name.startswith("LicenseRef-") or name in licences, f"the text of {name}")
        expect(name != "NOASSERTION", f"a licence of {package['name']}")

packages = {package["SPDXID"]: package for package in document["packages"]}


def related(how, backwards=False):
    ends = ("relatedSpdxElement", "spdxElementId") if backwards else ("spdxElementId", "relatedSpdxElement")
    return {packages[one[ends[1]]]["name"] for one in document["relationships"]
            if one["relationshipType"] == how and one[ends[0]] == "SPDXRef-Package-fathom"}


ours = packages["SPDXRef-Package-fathom"]
expect(ours["checksums"] == [{"algorithm": "SHA256", "checksumValue": sum_of_deb}], "the package's checksum")
expect({"SPDXRef-Package-fathom"} == {one["relatedSpdxElement"] for one in document["relationships"]
                                      if one["relationshipType"] == "DESCRIBES"}, "it is about the package")

# The linker's account: the files that `ldd` names are those of the packages, and none is missing.
loaded = related("DYNAMIC_LINK") | related("DEPENDS_ON")
for name in re.findall(r"=> /\S*/(\S+)", run("ldd", str(executable))):
    owners = run("dpkg-query", "--search", f"*/{name}").splitlines()
    expect(any(line.split(":")[0] in loaded for line in owners), f"{name} is loaded, and none of {sorted(loaded)}")
expect({"libc6"} <= related("DYNAMIC_LINK"), "libc is named by the executable")
expect({"libeigen3-dev", "nlohmann-json3-dev"} <= related("STATIC_LINK"), "libraries of headers are in it")
expect(not related("STATIC_LINK") & related("BUILD_DEPENDENCY_OF", backwards=True), "in it, or loaded by it")
expect(not any("test" in name for name in related("STATIC_LINK")), "nothing of the tests is in it")
expect({"leaflet", "uplot"} <= related("CONTAINS"), "the console's libraries")

# The sources, as git has them.
files = {one["fileName"]: {sum["algorithm"]: sum["checksumValue"] for sum in one["checksums"]} for one in document["files"]}
expect(files["./LICENSE"]["SHA256"] == hashlib.sha256((source / "LICENSE").read_bytes()).hexdigest(), "the sum of a source file")
tracked = {"./" + name for name in run("git", "-C", str(source), "ls-files").splitlines() if (source / name).is_file()}
expect(set(files) == {name for name in tracked if not (source / name).is_symlink()}, "all source files and no other")
code = hashlib.sha1("".join(sorted(sums["SHA1"] for sums in files.values())).encode()).hexdigest()
expect(packages["SPDXRef-Package-fathom-source"]["packageVerificationCode"]["packageVerificationCodeValue"] == code,
       "the verification code of the sources")
print(f"sbom: {len(loaded)} libraries loaded, {len(related('STATIC_LINK'))} compiled in, {len(files)} source files")
