// SPDX-License-Identifier: Apache-2.0
// `gaitctl view` as Foxglove sees it, by Foxglove's own library of the protocol.
// view_foxglove.mjs NODE_MODULES ws://HOST/?token=… role LAYOUT COUNT; COUNT as `gaitctl param list` has parameters
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';

const [, , modules, address, role, layout, count] = process.argv;
const require = createRequire(modules + '/');
const {FoxgloveClient} = require('@foxglove/ws-protocol');
const {WebSocket} = require('ws');
const protobuf = require('protobufjs');
const descriptor = require('protobufjs/ext/descriptor');

function check(holds, what) {
  if (holds) return;
  console.error(`FAILED: ${what}`);
  process.exit(1);
}
setTimeout(() => check(false, 'not done within 120 s'), 120e3).unref();

const client = new FoxgloveClient({ws: new WebSocket(address, FoxgloveClient.SUPPORTED_SUBPROTOCOL)});
const once = (event, wanted = () => true) => new Promise((resolve) => {
  const listener = (value) => {
    if (!wanted(value)) return;
    client.off(event, listener);
    resolve(value);
  };
  client.on(event, listener);
});
client.on('error', (error) => check(false, `error ${error}`));

const [info, services, channels] = await Promise.all(
    [once('serverInfo'), once('advertiseServices'), once('advertise')]);
check(info.name === 'gaitd' && info.metadata.role === role, `serverInfo ${JSON.stringify(info)}`);

// Every channel of the log, with a schema that decodes its messages.
const topics = new Map(channels.map((channel) => [channel.topic, channel]));
for (const topic of ['/gaitd/signals', '/gaitd/events', '/tf', '/joint_states', '/scene', '/robot_description']) {
  check(topics.has(topic), `no channel ${topic}: ${[...topics.keys()]}`);
}
const set = (channel) => descriptor.FileDescriptorSet.decode(Buffer.from(channel.schema, 'base64'));
const typeOf = (channel) => protobuf.Root.fromDescriptor(set(channel)).lookupType(channel.schemaName);
function decoder(channel) {
  const type = typeOf(channel);
  return (data) => type.decode(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
}

// What the layout shows is there.
const panels = JSON.parse(readFileSync(layout, 'utf8'));
const shownPaths = [];
for (const {topics: of = {}, layers = {}, paths = [], topicPath} of Object.values(panels.configById)) {
  shownPaths.push(...Object.keys(of), ...paths.map(({value}) => value), ...(topicPath ? [topicPath] : []),
                  ...Object.values(layers).map(({topic}) => topic).filter(Boolean));
}
check(shownPaths.length > 20, `the layout shows ${shownPaths}`);
for (const path of shownPaths) {
  const [topic, ...fields] = path.split('.');
  check(topics.has(topic), `the layout shows ${path}: no such channel`);
  let type = typeOf(topics.get(topic));
  for (const field of fields) {
    const found = type?.fields?.[field] ?? type?.fields?.[protobuf.util.camelCase(field)];
    check(found, `the layout shows ${path}: no ${field}`);
    type = found.resolve().resolvedType;
  }
  check(!fields.length || !(type instanceof protobuf.Type), `the layout shows ${path}, which is no value`);
}
const placed = (node) => typeof node === 'string' ? [node] : [...placed(node.first), ...placed(node.second)];
check(placed(panels.layout).sort().join() === Object.keys(panels.configById).sort().join(),
      `the layout places ${placed(panels.layout)}`);

const newest = new Map();
const decode = new Map();
client.on('message', ({subscriptionId, timestamp, data}) => {
  const [topic, decoded] = decode.get(subscriptionId);
  newest.set(topic, {timestamp, message: decoded(data)});
});
for (const [topic, channel] of topics) decode.set(client.subscribe(channel.id), [topic, decoder(channel)]);
let time = 0n;
client.on('time', ({timestamp}) => { time = timestamp; });
const until = async (holds, what) => {
  for (let i = 0; i < 600; ++i) {
    if (holds()) return;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  check(false, what);
};
await until(() => ['/gaitd/signals', '/tf', '/joint_states', '/scene', '/robot_description']
    .every((topic) => newest.has(topic)), `messages of ${[...newest.keys()]} only`);
const pelvis = () => newest.get('/gaitd/signals').message.pelvis;
check(pelvis().z > 0.5 && pelvis().z < 1.2, `pelvis at ${JSON.stringify(pelvis())}`);
check(newest.get('/tf').message.transforms.length > 25, 'transforms of all bodies');
check(newest.get('/joint_states').message.joints[0].name.length >= 28, 'all joints');
check(Buffer.from(newest.get('/robot_description').message.data).includes('<robot'), 'the URDF');
check(newest.get('/scene').message.entities.length > 0, 'what is drawn');
await until(() => time > 0n, 'no time');

// Parameters, read and set.
client.getParameters([], 'all');
const all = await once('parameterValues', ({id}) => id === 'all');
check(all.parameters.length === Number(count), `${all.parameters.length} parameters, not ${count}`);
const height = () => {
  client.getParameters(['gait.swing_height'], 'one');
  return once('parameterValues', ({id}) => id === 'one').then(({parameters}) => parameters[0].value);
};
const before = await height();

// Services.
const call = (name, params) => {
  const service = services.find((one) => one.name === name);
  check(service, `no service ${name}`);
  const callId = call.next = (call.next ?? 0) + 1;
  const answer = Promise.race([
    once('serviceCallResponse', (one) => one.callId === callId)
        .then(({data}) => JSON.parse(new TextDecoder().decode(data))),
    once('serviceCallFailure', (one) => one.callId === callId)]);
  client.sendServiceCallRequest(
      {serviceId: service.id, callId, encoding: 'json', data: new TextEncoder().encode(params === undefined ? '' : JSON.stringify(params))});
  return answer;
};
if (role === 'observe') {
  check((await call('walk', {steps: 2, length: 0.2})).message?.includes('command'), 'an observer walks');
  const told = once('status');
  client.setParameters([{name: 'gait.swing_height', value: 0.05}], 'set');
  check((await told).message.includes('command'), 'an observer sets a parameter');
  check(await height() === before, 'it was set');
} else {
  client.setParameters([{name: 'gait.swing_height', value: before * 1.1}], 'set');
  await once('parameterValues', ({id}) => id === 'set');
  check(Math.abs(await height() - before * 1.1) < 1e-9, `set to ${await height()}`);
  client.setParameters([{name: 'gait.swing_height', value: before}], 'back');
  await once('parameterValues', ({id}) => id === 'back');
  check((await call('walk', {steps: 0})).message?.includes('steps'), 'a refusal has its reason');
  check((await call('mode', {mode: 'walk-straight'})).accepted, 'mode');
  const from = pelvis().x ?? 0;
  check((await call('walk', {steps: 3, length: 0.3})).accepted, 'walk');
  await until(() => pelvis().x > from + 0.5, 'it does not walk');
  check((await call('stop')).accepted, 'stop');
}
check((await call('estop')).accepted, 'estop');
await until(() => newest.get('/gaitd/events')?.message.kind !== undefined, 'no event of the stop');
if (role !== 'observe') check((await call('reset')).accepted, 'reset');
console.log(`as Foxglove, with the role ${role}: all of it`);
process.exit(0);
