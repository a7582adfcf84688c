// Access to a report, and formatting of its figures.

const absent = '–';

function isNumber(value) {
  return typeof value === 'number' && Number.isFinite(value);
}

// A value with about three significant digits; "0" only for exactly 0.
function figure(value) {
  if (!isNumber(value)) return absent;
  const size = Math.abs(value);
  if (value === 0) return '0';
  if (size < 0.001) return power(value);
  return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3);
}

function power(value) {
  const [digits, exponent] = value.toExponential(1).split('e');
  const raised = [...exponent.replace('+', '')].map(sign => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(sign)]);
  return digits + '·10' + raised.join('');
}

function fixed(value, decimals) {
  return isNumber(value) ? value.toFixed(decimals) : absent;
}

// 2097152 as "2 097 152", with thin spaces.
function grouped(value) {
  return isNumber(value) ? String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, '\u2009') : absent;
}

// With its sign.
function signed(value) {
  return isNumber(value) ? (value < 0 ? '−' : '') + figure(Math.abs(value)) : absent;
}

function percent(share, decimals = 1) {
  return isNumber(share) ? (100 * share).toFixed(decimals) : absent;
}

function withUnit(title, unit) {
  return title + (unit ? ', ' + unit : '');
}

function counted(count, thing, things = thing + 's') {
  return count + ' ' + (count === 1 ? thing : things);
}

// The value at "reprojection_px.rms", or undefined.
function at(object, path) {
  return path.split('.').reduce((value, key) => (value === null || value === undefined ? undefined : value[key]), object);
}

function labelOf(row) {
  if (row.label) return row.label;
  const values = Object.entries(row.params || {}).map(([name, value]) => name + '=' + value);
  return values.length ? row.technique + ':' + values.join(',') : String(row.technique);
}

function isMeasured(row) {
  return isNumber(at(row, 'ms.median'));
}

// Whether the picture of a row shows no terrain.
function showsNothing(row) {
  return Boolean(row.error) && !row.error.reprojection_px;
}

// Unbounded pixels are in no other figure of the error.
function unboundedText(row) {
  const unbounded = at(row, 'error.reprojection_px.unbounded');
  return unbounded ? ' +' + grouped(unbounded) + ' ∞' : '';
}

function dropOf(row) {
  return isNumber(row.ratio_to_texture) && row.ratio_to_texture > 0 ? 1 - 1 / row.ratio_to_texture : undefined;
}

// The views of the suite objects are no pose.
function viewOf(row) {
  return [row.scene, row.objects ? row.objects.buildings + ' buildings' : row.pose].filter(Boolean).join(', ');
}

function titleOf(row) {
  return row.test ? row.test + ' · ' + viewOf(row) : viewOf(row);
}

// Rows of one test, scene and pose, in the order of the report.
function groupsOf(rows) {
  const groups = new Map();
  rows.forEach((row, index) => {
    const key = JSON.stringify([row.suite, row.test, row.scene, row.pose]);
    if (!groups.has(key)) groups.set(key, {title: titleOf(row), scene: row.scene, pose: row.pose, rows: []});
    groups.get(key).rows.push({row, index});
  });
  return [...groups.values()];
}

function techniquesOf(rows) {
  return [...new Set(rows.map(row => row.technique))];
}

function unique(values) {
  return [...new Set(values.filter(value => value !== undefined && value !== null))];
}
