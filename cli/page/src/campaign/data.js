// SPDX-License-Identifier: Apache-2.0
// What gaitctl wrote into the page.

export const data = JSON.parse(document.getElementById('gaitd-data').textContent);

export const runs = new Map(data.runs.map((run) => [run.run, run]));
export const logs = new Map(data.logs.map((log) => [log.run, log]));

// The axes on which runs differ, by their place among all.
export const varied = data.axes.map((axis, place) => ({...axis, place}))
    .filter(({labels}) => labels.length > 1);

export const shortName = (scenario) => scenario.replace(/^.*\//, '').replace(/\.yaml$/, '');
export const label = (axis, k) => axis.key === 'scenario' ? shortName(axis.labels[k]) : axis.labels[k];

const kUnits = {duration: 's', fall_time: 's', icp_error_rms: 'm', icp_error_max: 'm', foot_slip_max: 'm',
                stance_knee_mean: 'rad'};
export const unit = (figure) => kUnits[figure] ? ` (${kUnits[figure]})` : '';

export const isNumeric = (axis) => axis.labels.length > 2 && axis.labels.every((one) => one !== '' && isFinite(one));
