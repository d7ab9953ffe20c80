// Decodes a recording with readers of others: decode.mjs FILE.mcap [EXPECTED]
// EXPECTED has a line for each message: topic, and the values of all fields in the order of their text.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import { leaves } from "../../support/leaves.mjs";

const require = createRequire(join(process.env.FATHOM_NPM_DIR, "package.json"));
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parseIDL } = require("@foxglove/omgidl-parser");
const { MessageReader } = require("@foxglove/omgidl-serialization");
const { decompress: unzstd } = require("fzstd");

// LZ4 frames, which no package of npm without native code reads: blocks of literals and matches.
function unlz4(frame, size) {
  const view = new DataView(frame.buffer, frame.byteOffset, frame.byteLength);
  const flags = frame[4];
  let at = 6 + (flags & 8 ? 8 : 0) + (flags & 1 ? 4 : 0) + 1;
  const out = new Uint8Array(Number(size));
  let end = 0;
  for (;;) {
    const head = view.getUint32(at, true);
    at += 4;
    if (head === 0) break;
    const length = head & 0x7fffffff;
    if (head >>> 31) {
      out.set(frame.subarray(at, at + length), end);
      end += length;
      at += length;
    } else {
      const stop = at + length;
      const long = (first) => {
        let n = first;
        if (first === 15) for (let more = 255; more === 255; n += more) more = frame[at++];
        return n;
      };
      while (at < stop) {
        const token = frame[at++];
        const literals = long(token >> 4);
        out.set(frame.subarray(at, at + literals), end);
        end += literals;
        at += literals;
        if (at >= stop) break;
        const back = frame[at] | (frame[at + 1] << 8);
        at += 2;
        for (let n = long(token & 15) + 4; n > 0; n--, end++) out[end] = out[end - back];
      }
    }
    if (flags & 16) at += 4;
  }
  return out;
}
const decompressHandlers = { zstd: (bytes, size) => unzstd(bytes, new Uint8Array(Number(size))), lz4: unlz4 };

const file = readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(file.length),
  read: async (offset, size) => new Uint8Array(file.buffer, file.byteOffset + Number(offset), Number(size)),
};
const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const decoders = new Map();
for (const schema of indexed.schemasById.values()) {
  if (schema.encoding !== "omgidl") throw new Error(`${schema.name}: encoding ${schema.encoding}`);
  const parsed = parseIDL(new TextDecoder().decode(schema.data));
  decoders.set(schema.id, {
    name: schema.name,
    reader: new MessageReader(schema.name, parsed),
    definitions: new Map(parsed.map((definition) => [definition.name, definition])),
  });
}
const lines = [];
for await (const message of indexed.readMessages()) {
  const channel = indexed.channelsById.get(message.channelId);
  if (channel.messageEncoding !== "cdr") throw new Error(`${channel.topic}: ${channel.messageEncoding}`);
  const decoder = decoders.get(channel.schemaId);
  const values = [];
  const field = { isComplex: true, type: decoder.name };
  leaves(decoder.reader.readMessage(message.data), field, decoder.definitions, values);
  lines.push(`${channel.topic} ${values.sort().join(" ")}`);
}
let streamed = 0;
const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(new Uint8Array(file));
for (let record; (record = stream.nextRecord()); ) if (record.type === "Message") streamed++;
if (!stream.done()) throw new Error("the stream reader is not done at the end of the file");
if (streamed !== lines.length) throw new Error(`${streamed} messages streamed, ${lines.length} by the index`);
const said = Number(indexed.statistics.messageCount);
if (said !== lines.length) throw new Error(`${said} messages in the statistics, ${lines.length} read`);

if (process.argv[3] !== undefined) {
  const expected = readFileSync(process.argv[3], "utf8").trimEnd().split("\n");
  if (expected.length !== lines.length) throw new Error(`${lines.length} messages, expected ${expected.length}`);
  for (let i = 0; i < lines.length; i++) {
    if (lines[i] === expected[i]) continue;
    const [a, b] = [lines[i].split(" "), expected[i].split(" ")];
    const at = a.findIndex((one, n) => one !== b[n]);
    console.error(`message ${i} of ${a[0]}: ${a.length} values, expected ${b.length}; value ${at}: ${a[at]}, expected ${b[at]}`);
    process.exitCode = 1;
  }
}
console.log(`${lines.length} messages of ${new Set(lines.map((line) => line.split(" ")[0])).size} topics decoded`);
