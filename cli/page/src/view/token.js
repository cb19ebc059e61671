// SPDX-License-Identifier: Apache-2.0
const kKey = 'gaitd-token';

// The token from the address, which is then taken out of it: an address is copied and shown around.
// Later loads of this tab have it from its memory. Empty if there is none.
export function takeToken() {
  const rest = new URLSearchParams(location.hash.slice(1)), given = rest.get('token');
  if (given !== null) {
    sessionStorage.setItem(kKey, given);
    rest.delete('token');
    const fragment = rest.toString();
    history.replaceState(null, '', location.pathname + location.search + (fragment && `#${fragment}`));
  }
  const token = sessionStorage.getItem(kKey) ?? '';
  return /^[0-9A-Za-z]+$/.test(token) ? token : '';
}
