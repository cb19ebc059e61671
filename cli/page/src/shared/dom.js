// SPDX-License-Identifier: Apache-2.0
// Everything that comes from the robot goes into the page as text, never as HTML.

export const $ = (id) => document.getElementById(id);

export function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

// Without touching what is as it should be: a change of the same costs as much as another one.
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// A button that cannot be used says why.
export function enable(element, obstacle, title = '') {
  if (element.disabled !== Boolean(obstacle)) element.disabled = Boolean(obstacle);
  const text = obstacle || title;
  if (element.title !== text) element.title = text;
}

export const isText = (element) =>
    element.matches?.('input:not([type=range], [type=checkbox]), textarea, select') ?? false;

// Of those, the ones into which one writes spaces.
export const takesSpaces = (element) =>
    element.matches?.('input:is([type=search], [type=text], :not([type])), textarea') ?? false;
