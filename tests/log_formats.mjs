// SPDX-License-Identifier: Apache-2.0
// Reads a log with the official MCAP reader: log_formats.mjs NODE_MODULES FILE [cut]
// Exit code 1 with the reason if anything is not as it should be.
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';

const [modules, file, cut] = process.argv.slice(2);
const require = createRequire(`${modules}/`);
const {McapIndexedReader, McapStreamReader} = require('@mcap/core');
const {decompress} = require('fzstd');
const protobuf = require('protobufjs');
const {FileDescriptorSet} = require('protobufjs/ext/descriptor');

function check(holds, what) {
  if (holds) return;
  console.error(`FAILED: ${what}`);
  process.exit(1);
}

const bytes = readFileSync(file);
const options = {decompressHandlers: {zstd: (data, size) => decompress(data, new Uint8Array(Number(size)))}};

async function readMessages() {
  const schemas = new Map(), channels = new Map(), messages = [];
  if (cut) {
    const reader = new McapStreamReader(options);
    reader.append(bytes);
    for (let record; (record = reader.nextRecord());) {
      if (record.type === 'Schema') schemas.set(record.id, record);
      if (record.type === 'Channel') channels.set(record.id, record);
      if (record.type === 'Message') messages.push(record);
    }
  } else {
    const reader = await McapIndexedReader.Initialize({...options, readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
    }});
    for (const [id, schema] of reader.schemasById) schemas.set(id, schema);
    for (const [id, channel] of reader.channelsById) channels.set(id, channel);
    for await (const message of reader.readMessages()) messages.push(message);
  }
  const types = new Map();
  for (const {id, name, encoding, data} of schemas.values()) {
    check(encoding === 'protobuf', `schema ${name} is ${encoding}`);
    types.set(id, protobuf.Root.fromDescriptor(FileDescriptorSet.decode(data)).lookupType(name));
  }
  const topics = new Map();
  for (const {topic, schemaId} of channels.values()) {
    topics.set(topic, {schema: schemas.get(schemaId).name, messages: []});
  }
  for (const {channelId, logTime, data} of messages) {
    const {topic, schemaId} = channels.get(channelId);
    topics.get(topic).messages.push({time: Number(logTime) / 1e9, data, type: types.get(schemaId)});
  }
  return topics;
}

const decode = ({type, data}) => type.toObject(type.decode(data), {defaults: true});
const topics = await readMessages();
for (const [topic, {schema, messages}] of topics) console.log(`${topic} ${schema}: ${messages.length}`);

const standard = {'/tf': 'foxglove.FrameTransforms', '/joint_states': 'foxglove.JointStates',
                  '/scene': 'foxglove.SceneUpdate', '/robot_description': 'foxglove.RobotDescription'};
for (const [topic, schema] of Object.entries(standard)) {
  check(topics.get(topic)?.schema === schema, `${topic} is ${topics.get(topic)?.schema}, not ${schema}`);
  check(topics.get(topic).messages.length > 0, `no message on ${topic}`);
}
const signals = topics.get('/gaitd/signals').messages;
const duration = signals.at(-1).time - signals[0].time;
const rate = topics.get('/tf').messages.length / duration;
check(rate > 20 && rate < 40, `${rate} transforms per second`);

// The frames of the robot, the joints and the signals tell the same.
const signalsAt = (time) => decode(signals.find((message) => message.time === time));
for (const message of [topics.get('/tf').messages[0], topics.get('/tf').messages.at(-1)]) {
  const {transforms} = decode(message);
  const frames = new Set(transforms.map(({child_frame_id}) => child_frame_id));
  check(frames.size === transforms.length && frames.size > 20, `${frames.size} frames`);
  for (const {parent_frame_id: parent} of transforms) {
    check(parent === 'world' || frames.has(parent), `the parent ${parent} is no frame`);
  }
  const root = transforms.find(({parent_frame_id}) => parent_frame_id === 'world');
  const {pelvis} = signalsAt(message.time);
  for (const axis of ['x', 'y', 'z']) {
    check(Math.abs(root.translation[axis] - pelvis[axis]) < 1e-12,
          `at ${message.time} s ${root.child_frame_id} is at ${axis} = ${root.translation[axis]}, not ${pelvis[axis]}`);
  }
  const stamp = Number(root.timestamp.seconds) + root.timestamp.nanos / 1e9;
  check(Math.abs(stamp - message.time) < 1e-9, `stamps differ: ${stamp} s, ${message.time} s`);
}
const last = topics.get('/joint_states').messages.at(-1);
const {name, position, velocity, effort} = decode(last).joints[0];
check(name.length > 20 && [position, velocity, effort].every((list) => list.length === name.length),
      `${name.length} joints with ${position.length} positions`);
const {joint} = signalsAt(last.time);
name.forEach((one, i) => check(joint[one].position === position[i], `joint ${one}`));

const scene = decode(topics.get('/scene').messages.at(-1));
const ids = new Map(scene.entities.map((entity) => [entity.id, entity]));
check(ids.get('footsteps')?.lines.length === 2 && ids.get('footsteps').lines[0].points.length >= 4,
      'no outlines of footsteps');
check(ids.get('balance')?.spheres.length === 4, 'no markers of ICP, plan, CMP and CoP');
check(decode(topics.get('/scene').messages[0]).entities.some(({id, cubes}) => id === 'terrain' && cubes.length),
      'no terrain');
const description = decode(topics.get('/robot_description').messages[0]);
check(Buffer.from(description.data).includes('<robot') && description.format === 'urdf', 'no URDF');
