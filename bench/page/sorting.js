// Tables that a click on a heading sorts. A table has entries {row, index}, a node for each of them
// by its index, and a body.

// Absent values come last in both directions.
function compared(a, b, direction) {
  const isAbsent = value => value === undefined || value === null || value === '';
  if (isAbsent(a) || isAbsent(b)) return isAbsent(a) - isAbsent(b);
  const order = typeof a === 'string' ? a.localeCompare(b, 'en', {numeric: true}) : a < b ? -1 : a > b ? 1 : 0;
  return direction * order;
}

function sortBy(table, column, head) {
  const ascending = head.getAttribute('aria-sort') !== 'ascending';
  table.node.querySelectorAll('th[aria-sort]').forEach(other => other.removeAttribute('aria-sort'));
  head.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
  table.entries.sort((a, b) => compared(column.value(a.row), column.value(b.row), ascending ? 1 : -1));
  table.body.append(...table.entries.map(entry => table.nodes.get(entry.index)));
}

function sortableHead(table, column) {
  const head = element('th', {scope: 'col'});
  head.append(element('button', {type: 'button', onclick: () => sortBy(table, column, head)},
    column.title, element('span', {class: 'arrow', 'aria-hidden': 'true'})));
  return head;
}
