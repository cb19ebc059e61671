// SPDX-License-Identifier: Apache-2.0
const kKey = 'gaitd-token';

// The token from the address, which is then taken out of it: an address is copied and shown around.
// Later loads of this tab have it from its memory. Empty if there is none.
export function takeToken() {
  const rest = new URLSearchParams(location.hash.slice(1));
  const token = rest.get('token') ?? remembered();
  if (rest.has('token')) {
    remember(token);
    rest.delete('token');
    const fragment = rest.toString();
    history.replaceState(null, '', location.pathname + location.search + (fragment && `#${fragment}`));
  }
  return /^[0-9A-Za-z]+$/.test(token) ? token : '';
}

// A browser may keep nothing; then a page that is loaded again asks for the address.
function remember(token) {
  try {
    sessionStorage.setItem(kKey, token);
  } catch { /* as said */ }
}

function remembered() {
  try {
    return sessionStorage.getItem(kKey) ?? '';
  } catch {
    return '';
  }
}
