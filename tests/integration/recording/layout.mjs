// Whether what a layout shows exists in a recording that has every type: layout.mjs FILE.mcap LAYOUT.json
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(join(process.env.FATHOM_NPM_DIR, "package.json"));
const { McapIndexedReader } = require("@mcap/core");
const { parseIDL } = require("@foxglove/omgidl-parser");
const { decompress: unzstd } = require("fzstd");

const file = readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(file.length),
  read: async (offset, size) => new Uint8Array(file.buffer, file.byteOffset + Number(offset), Number(size)),
};
const decompressHandlers = { zstd: (bytes, size) => unzstd(bytes, new Uint8Array(Number(size))) };
const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const types = new Map();
for (const channel of indexed.channelsById.values()) {
  const schema = indexed.schemasById.get(channel.schemaId);
  const parsed = parseIDL(new TextDecoder().decode(schema.data));
  types.set(channel.topic, { root: schema.name, all: new Map(parsed.map((one) => [one.name, one])) });
}

const modifiers = new Set(["degrees", "sqrt"]);
// Why a message path leads nowhere; empty when it leads to one value, or to a whole message.
function objection(path) {
  const parts = /^(fathom\/v1\/\w+)((?:\{\w+==\d+\})*)((?:\.\w+(?:\[\d+\])?)*)((?:\.@\w+)*)$/.exec(path);
  if (parts === null) return "is no message path that this test reads";
  const type = types.get(parts[1]);
  if (type === undefined) return `no topic ${parts[1]}`;
  const field = (owner, name) => type.all.get(owner)?.definitions.find((one) => one.name === name);
  for (const [, name] of parts[2].matchAll(/\{(\w+)==/g))
    if (field(type.root, name) === undefined) return `${type.root} has no ${name}`;
  let owner = type.root;
  for (const [, name, index] of parts[3].matchAll(/\.(\w+)(?:\[(\d+)\])?/g)) {
    const found = field(owner, name);
    if (found === undefined) return `${owner} has no ${name}`;
    const many = found.arrayLengths !== undefined || found.isArray === true;
    if (many !== (index !== undefined)) return `${owner}.${name} is ${many ? "" : "no "}array`;
    if (found.arrayLengths !== undefined && Number(index) >= found.arrayLengths[0])
      return `${owner}.${name} has ${found.arrayLengths[0]} elements`;
    owner = found.isComplex ? found.type : undefined;
  }
  for (const [, name] of parts[4].matchAll(/\.@(\w+)/g)) if (!modifiers.has(name)) return `unknown modifier ${name}`;
  return "";
}

const layout = JSON.parse(readFileSync(process.argv[3], "utf8"));
const paths = [];
const shown = new Set();
for (const panel of Object.values(layout.configById)) {
  for (const path of [...(panel.paths ?? []), ...(panel.xAxisPath ? [panel.xAxisPath] : [])]) paths.push(path.value);
  if (panel.topicPath) paths.push(panel.topicPath);
}
(function walk(node) {
  if (typeof node === "string") {
    if (!(node in layout.configById)) throw new Error(`the layout shows ${node}, which has no configuration`);
    shown.add(node);
    for (const tab of layout.configById[node].tabs ?? []) walk(tab.layout);
  } else {
    walk(node.first);
    walk(node.second);
  }
})(layout.layout);
for (const name of Object.keys(layout.configById)) if (!shown.has(name)) throw new Error(`${name} is not shown`);
if (paths.length === 0) throw new Error("the layout shows nothing");
// The test itself must find what does not exist.
for (const path of ["fathom/v1/nav_state.nothing", "fathom/v1/nothing.mode", "fathom/v1/nav_state.rpy_rad[3]", "fathom/v1/nav_state.mode[0]"])
  if (objection(path) === "") throw new Error(`${path} is taken for a path`);
let bad = 0;
for (const path of paths) {
  const why = objection(path);
  if (why === "") continue;
  bad++;
  console.error(`${process.argv[3]}: ${path}: ${why}`);
}
if (bad > 0) process.exitCode = 1;
console.log(`${paths.length} paths of the layout, ${bad} lead nowhere`);
