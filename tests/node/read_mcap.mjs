// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file with the official library, in both ways, and prints what it holds as JSON.
// usage: node read_mcap.mjs NODE_MODULES FILE
import { createRequire } from "node:module";
import { open, readFile } from "node:fs/promises";

const [modules, file] = process.argv.slice(2);
const require = createRequire(modules + "/");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const Ajv = require("ajv");
const official = require("@foxglove/schemas/jsonschema");

/** A schema without the texts that explain it. */
function bare(schema) {
  if (Array.isArray(schema)) return schema.map(bare);
  if (schema === null || typeof schema !== "object") return schema;
  const isText = (key) => ["title", "description", "$comment"].includes(key) && typeof schema[key] === "string";
  return Object.fromEntries(Object.keys(schema).sort().filter((key) => !isText(key)).map((key) => [key, bare(schema[key])]));
}

/** All records from front to back; check sums are verified on the way. */
async function stream() {
  const reader = new McapStreamReader({ validateCrcs: true, includeChunks: true });
  const counts = {};
  reader.append(await readFile(file));
  for (let record; (record = reader.nextRecord()); ) counts[record.type] = (counts[record.type] ?? 0) + 1;
  if (reader.bytesRemaining() !== 0 || !reader.done()) throw new Error("the file does not end where it should");
  return counts;
}

/** By the summary and the indexes. */
async function indexed() {
  const handle = await open(file);
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  const ajv = new Ajv({ strict: false });
  const decoder = new TextDecoder();
  const channels = {};
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    const text = JSON.parse(decoder.decode(schema.data));
    const name = schema.name.replace("foxglove.", "");
    channels[channel.id] = {
      topic: channel.topic,
      schema: schema.name,
      encodings: [channel.messageEncoding, schema.encoding],
      isOfficial: JSON.stringify(bare(text)) === JSON.stringify(bare(official[name])),
      check: ajv.compile(official[name]),
      messages: [],
      invalid: 0,
    };
  }
  for await (const message of reader.readMessages()) {
    const channel = channels[message.channelId];
    const data = JSON.parse(decoder.decode(message.data));
    if (!channel.check(data)) channel.invalid++;
    channel.messages.push({ logTime: message.logTime.toString(), sequence: message.sequence, ...data });
  }
  const metadata = [];
  for await (const record of reader.readMetadata()) metadata.push(Object.fromEntries(record.metadata));
  await handle.close();
  for (const channel of Object.values(channels)) delete channel.check;
  const s = reader.statistics;
  const statistics = { messages: Number(s.messageCount), chunks: s.chunkCount, start: s.messageStartTime.toString(), end: s.messageEndTime.toString() };
  return { channels: Object.values(channels), metadata, statistics };
}

console.log(JSON.stringify({ records: await stream(), ...(await indexed()) }));
