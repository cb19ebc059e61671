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

// What it is about: events of the same follow each other by the dozen while somebody drives or pushes.
export function subject({kind, text}) {
  const what = text?.command ?? text?.push;
  return kind !== 'fault' && what ? `${kind} ${what} ${text.accepted ?? ''}` : undefined;
}

const shorter = (_, value) => typeof value === 'number' ? Number(value.toPrecision(5)) : value;

// In a line.
export function sentence({text}) {
  if (typeof text === 'string') return text;
  return Object.entries(text ?? {}).map(([key, value]) =>
      `${key} ${typeof value === 'string' ? value : JSON.stringify(value, shorter)}`).join(', ');
}
