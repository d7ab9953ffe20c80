// A client of Foxglove's own library: client.mjs read|stuck|count|babble|deaf URL SECONDS
//   read   subscribes to every channel and writes a line for each message: topic, and the values of all fields in the
//          order of their text
//   count  subscribes to the navigation state and writes how many came, and how old the last one was, in ms
//   stuck  subscribes to everything and reads nothing
//   babble says 3000 times what is no wish, and hears what the server says to that
//   deaf   asks for what is not on offer, again and again, and reads nothing, until it is let go
// Ends with 3 when the server does not let it in.
import { createRequire } from "node:module";
import { join } from "node:path";

import { leaves } from "../../support/leaves.mjs";

const require = createRequire(join(process.env.FATHOM_NPM_DIR, "package.json"));
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parseIDL } = require("@foxglove/omgidl-parser");
const { MessageReader } = require("@foxglove/omgidl-serialization");
const WebSocket = require("ws");

const [mode, url, seconds] = process.argv.slice(2);
const socket = new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL], { rejectUnauthorized: false });
socket.on("unexpected-response", (_, answer) => {
  answer.on("data", (text) => process.stderr.write(`${answer.statusCode} ${text}`));
  answer.on("end", () => process.exit(3));
});
const client = new FoxgloveClient({ ws: socket });
const decoders = new Map();
let count = 0;
let age_ms = NaN;
client.on("error", (error) => console.error(String(error)));
let answers = 0;
client.on("status", (status) => {
  if (mode !== "babble") return console.error(`status: ${status.message}`);
  if (++answers === 3000) process.exit(0);
});
client.on("serverInfo", (info) => console.error(`server: ${info.name}`));
client.on("advertise", (channels) => {
  for (const channel of channels) {
    if (channel.encoding !== "cdr" || channel.schemaEncoding !== "omgidl") throw new Error(channel.topic);
    if (mode === "count" && channel.topic !== "fathom/v1/nav_state") continue;
    const parsed = parseIDL(channel.schema);
    decoders.set(client.subscribe(channel.id), {
      topic: channel.topic,
      name: channel.schemaName,
      reader: new MessageReader(channel.schemaName, parsed),
      definitions: new Map(parsed.map((definition) => [definition.name, definition])),
    });
  }
  console.error(`subscribed to ${decoders.size}`);
  if (mode === "babble") for (let i = 0; i < 3000; i++) socket.send("{}");
  if (mode === "deaf") nag();
  if (mode === "stuck") setTimeout(() => socket.pause(), 300);
});
function nag() {
  socket.pause();
  const subscriptions = Array.from({ length: 1000 }, (_, id) => ({ id, channelId: 4000000000 }));
  const wish = JSON.stringify({ op: "subscribe", subscriptions });
  const again = (error) => (error ? process.exit(0) : socket.send(wish, again));
  again();
}
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const decoder = decoders.get(subscriptionId);
  count++;
  age_ms = Date.now() - Number(timestamp / 1000000n);
  if (mode !== "read") return;
  const out = [];
  leaves(decoder.reader.readMessage(data), { isComplex: true, type: decoder.name }, decoder.definitions, out);
  console.log(`${decoder.topic} ${out.sort().join(" ")}`);
});
setTimeout(() => {
  if (mode === "babble" || mode === "deaf") process.exit(4);
  if (mode === "count") console.log(`${count} ${age_ms.toFixed(0)}`);
  process.exit(0);
}, 1000 * Number(seconds));
