// SPDX-License-Identifier: Apache-2.0

// What to show of a refusal of `what`: some of gaitd's messages begin with their method, others do not.
export const refused = (what, {message}) =>
    message.toLowerCase().startsWith(`${what.toLowerCase()}: `) ? message : `${what}: ${message}`;
