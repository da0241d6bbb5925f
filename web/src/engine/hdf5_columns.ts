// Blocks of columns of a file as one table, row after row.

const most_numbers = 15_000_000 / 8; // as of `hamflow view`

export function named_row_blocks(blocks: { names: string[]; numbers: ArrayLike<number | bigint> }[], rows: number): { columns: string[]; numbers: Float64Array; note: string } {
  const columns = blocks.flatMap((block) => block.names);
  const every = Math.max(1, Math.ceil((rows * columns.length) / most_numbers));
  const numbers = new Float64Array(Math.ceil(rows / every) * columns.length);
  let at = 0;
  for (let row = 0; row < rows; row += every) {
    for (const { names, numbers: source } of blocks) {
      for (let k = 0; k < names.length; ++k) numbers[at++] = Number(source[row * names.length + k]);
    }
  }
  return { columns, numbers, note: every === 1 ? "" : `one of every ${every} is shown` };
}
