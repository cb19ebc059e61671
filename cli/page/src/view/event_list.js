// SPDX-License-Identifier: Apache-2.0
// Of events what can be told without a page.

// An event as it comes, with its text as an object where it is JSON.
export function parsed(event) {
  if (typeof event.text !== 'string') return event;
  try {
    return {...event, text: JSON.parse(event.text)};
  } catch {
    return event;
  }
}

// Those that say once more what others say: gaitd plays them again in a replay.
export const isTwin = ({kind}) => kind === 'input' || kind === 'reply';

// What it is about: events of the same follow each other by the dozen while somebody drives or pushes.
export function subject({kind, text}) {
  const what = text?.push ?? text?.command;
  return kind !== 'fault' && what ? `${kind} ${what} ${text.accepted ?? ''}` : undefined;
}

const kFirst = ['command', 'push', 'accepted'], kLeftOut = ['request', 'body'];

const shorter = (_, value) => typeof value === 'number' ? Number(value.toPrecision(5)) : value;

// In a line.
export function sentence({text}) {
  if (typeof text === 'string') return text;
  const place = ([key]) => kFirst.includes(key) ? kFirst.indexOf(key) : kFirst.length;
  const isNothing = (value) => Array.isArray(value) && !value.length;
  const isWords = (value) => Array.isArray(value) && value.every((one) => typeof one === 'string');
  return Object.entries(text ?? {}).filter(([key, value]) => !kLeftOut.includes(key) && !isNothing(value))
      .sort((a, b) => place(a) - place(b)).map(([key, value]) =>
      `${key} ${typeof value === 'string' ? value : isWords(value) ? value.join(' ') : JSON.stringify(value, shorter)}`)
      .join(', ');
}
