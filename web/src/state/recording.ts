// The rows of a motion so far. When there are too many, every second one is dropped, from the first on.

export class Recording {
  private numbers = new Float64Array(1024);
  count = 0;
  /// Rows of the engine that one row stands for.
  every = 1;
  private skipped = 0;

  constructor(readonly width: number, private readonly most = 20_000) {}

  append(rows: Float64Array): void {
    for (let at = 0; at + this.width <= rows.length; at += this.width) {
      this.skipped = (this.skipped + 1) % this.every;
      if (this.skipped !== 0) continue;
      if (this.count === this.most) this.thin();
      const from = this.count * this.width;
      if (from + this.width > this.numbers.length) {
        const larger = new Float64Array(2 * this.numbers.length + this.width);
        larger.set(this.numbers);
        this.numbers = larger;
      }
      this.numbers.set(rows.subarray(at, at + this.width), from);
      ++this.count;
    }
  }

  at(row: number, column: number): number {
    return this.numbers[row * this.width + column]!;
  }

  column(column: number): Float64Array {
    const all = new Float64Array(this.count);
    for (let row = 0; row < this.count; ++row) all[row] = this.at(row, column);
    return all;
  }

  private thin(): void {
    const kept = Math.ceil(this.count / 2);
    for (let row = 0; row < kept; ++row) {
      this.numbers.copyWithin(row * this.width, 2 * row * this.width, (2 * row + 1) * this.width);
    }
    this.count = kept;
    this.every *= 2;
  }
}
