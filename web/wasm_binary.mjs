// The sections of a WebAssembly module.

/// A number in LEB128.
export function leb(number, is_signed = false) {
  const bytes = [];
  for (;;) {
    const low = number & 0x7f;
    number >>= 7;
    if (number === 0 && !(is_signed && low & 0x40)) return [...bytes, low];
    bytes.push(low | 0x80);
  }
}

export class Reader {
  at = 0;
  constructor(bytes) {
    this.bytes = bytes;
  }
  byte() {
    return this.bytes[this.at++];
  }
  number() {
    let [result, shift] = [0, 0];
    for (;; shift += 7) {
      const byte = this.byte();
      result |= (byte & 0x7f) << shift;
      if (byte < 0x80) return result >>> 0;
    }
  }
  skip(count) {
    return this.bytes.subarray(this.at, (this.at += count));
  }
  text() {
    return this.skip(this.number()).toString();
  }
  list(read) {
    return Array.from({ length: this.number() }, read);
  }
  /// An address or a place in the table: i32.const, a number that is not negative, end.
  constant() {
    if (this.byte() !== 0x41) throw new Error("a segment begins at no constant");
    const result = this.number();
    if (this.byte() !== 0x0b) throw new Error("a segment begins at no constant");
    return result;
  }
}

export function sections_of(bytes) {
  const read = new Reader(bytes);
  read.skip(8);
  const sections = [];
  while (read.at < bytes.length) sections.push({ id: read.byte(), content: read.skip(read.number()) });
  return sections;
}
