// Reads frames of MAVLink from a file with node-mavlink and prints one JSON object each. Usage: read.mjs NPM FILE [KEY]
import { createReadStream } from 'node:fs';
import { createRequire } from 'node:module';

const [npm, file, key] = process.argv.slice(2);
const require = createRequire(npm + '/package.json');
const { MavLinkPacketSplitter, MavLinkPacketParser, minimal, standard, common } = require('node-mavlink');
const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY };
const plain = (_, value) =>
  typeof value === 'bigint' ? Number(value) : typeof value === 'number' && !Number.isFinite(value) ? null : value;

const splitter = new MavLinkPacketSplitter();
createReadStream(file).pipe(splitter).pipe(new MavLinkPacketParser()).on('data', (packet) => {
  const type = registry[packet.header.msgid];
  const fields = type ? packet.protocol.data(packet.payload, type) : {};
  const signed = packet.signature
    ? packet.signature.matches(Buffer.from(key ?? '', 'hex'))
    : null;
  console.log(JSON.stringify({ name: type?.MSG_NAME, system: packet.header.sysid, component: packet.header.compid,
    magic: packet.header.magic, signed, fields }, plain));
}).on('end', () => console.log(JSON.stringify({ invalid: splitter.invalidPackages, unknown: splitter.unknownPackagesCount })));
