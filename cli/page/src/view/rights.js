// SPDX-License-Identifier: Apache-2.0
// Who may do what: docs/security.md. gaitd decides; here buttons say beforehand what it would.

const kRoles = ['observe', 'command', 'administer'];
const kAdministers = ['plugin.rollback', 'plugin.swap', 'sim.push', 'sim.reset'];
const kGuardedScopes = ['safety', 'limits', 'swap', 'realtime'];

export const isGuarded = (parameter) => kGuardedScopes.includes(parameter.split('.')[0]);

const atLeast = (role, needed) => kRoles.indexOf(role) >= kRoles.indexOf(needed);

// Why `method` cannot be called now, of parameter `name` for param.set; empty if nothing is known.
// `state`: {online, connected, role, simulation, status}.
export function obstacle(method, {online, connected, role, simulation, status}, name = '') {
  if (!online) return 'no connection to gaitctl view';
  if (method === 'estop') return '';
  const guarded = method === 'param.set' && isGuarded(name);
  const needed = guarded || kAdministers.includes(method) ? 'administer' : 'command';
  if (!atLeast(role, needed)) {
    return role === 'observe' ? 'watching only: this address has the role observe' :
        `needs the role ${needed}; this page has ${role}`;
  }
  if (method === 'record') return '';
  if (!connected) return 'gaitd is away';
  if (method.startsWith('sim.') && !simulation) return 'only in a simulation';
  if (guarded && !simulation && status?.state !== 'disarmed') return 'only while the robot is disarmed';
  return '';
}
