// The order in which a map is painted: a coarse grid first, then the cells between.

export interface Task {
  first: number; // cells first, first + stride, ... of a map, row after row
  stride: number;
  count: number;
  spacing: number; // of the grid that the task belongs to
}

const coarsest = 16;

export function tasks_of(columns: number, rows: number): Task[] {
  const all: Task[] = [];
  for (let spacing = coarsest; spacing >= 1; spacing /= 2) {
    for (let row = 0; row < rows; row += spacing) {
      const is_new_row = spacing === coarsest || row % (2 * spacing) !== 0;
      const from = is_new_row ? 0 : spacing; // the others are there already
      const stride = is_new_row ? spacing : 2 * spacing;
      const count = Math.ceil((columns - from) / stride);
      if (count > 0) all.push({ first: row * columns + from, stride, count, spacing });
    }
  }
  return all;
}
