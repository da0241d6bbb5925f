// The rows of a motion so far, column by column. When there are too many, every second one is dropped.

const most_numbers = 4_000_000; // 32 MB

export class Recording {
  private numbers: Float64Array;
  private room = 256; // rows
  private readonly most: number;
  private skipped = 0;
  count = 0;
  /// Rows of the engine that one row stands for.
  every = 1;

  constructor(readonly width: number, most = 20_000) {
    this.most = Math.max(2, most === Infinity ? most : Math.min(most, Math.floor(most_numbers / width)));
    this.numbers = new Float64Array(this.room * width);
  }

  /// All of these rows.
  static of(width: number, rows: Float64Array): Recording {
    const all = new Recording(width, Infinity);
    all.count = all.room = Math.floor(rows.length / width);
    all.numbers = new Float64Array(all.room * width);
    for (let row = 0, at = 0; row < all.count; ++row) {
      for (let column = 0; column < width; ++column) all.numbers[column * all.room + row] = rows[at++]!;
    }
    return all;
  }

  /// @param rows numbers row after row
  append(rows: Float64Array): void {
    for (let at = 0; at + this.width <= rows.length; at += this.width) {
      this.skipped = (this.skipped + 1) % this.every;
      if (this.skipped !== 0) continue;
      if (this.count === this.most) this.thin();
      if (this.count === this.room) this.enlarge();
      for (let column = 0; column < this.width; ++column) this.numbers[column * this.room + this.count] = rows[at + column]!;
      ++this.count;
    }
  }

  at(row: number, column: number): number {
    return this.numbers[column * this.room + row]!;
  }
  /// A column as it is now: a view of memory, valid until the next append.
  column(column: number): Float64Array {
    return this.numbers.subarray(column * this.room, column * this.room + this.count);
  }

  private enlarge(): void {
    const larger = new Float64Array(2 * this.room * this.width);
    for (let column = 0; column < this.width; ++column) larger.set(this.column(column), column * 2 * this.room);
    this.numbers = larger;
    this.room *= 2;
  }
  private thin(): void {
    const kept = Math.ceil(this.count / 2);
    for (let column = 0; column < this.width; ++column) {
      const numbers = this.column(column);
      for (let row = 0; row < kept; ++row) numbers[row] = numbers[2 * row]!;
    }
    this.count = kept;
    this.every *= 2;
  }
}
