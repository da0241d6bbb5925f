// The engine has two parts: what the first picture needs, and the rest (web/split.mjs).

const most_bytes = 64; // that a placeholder takes, with up to 20 parameters

/// A module with a function for each place of the table whose function is in the rest. It calls `load`, which fills the
/// table, and then the function that is at its place now. Arguments, results and exceptions pass by WebAssembly alone.
/// The first picture waits for these 12 000 functions, so that they are written into one array.
function placeholders(description: Uint8Array): Uint8Array {
  let from = 0;
  const number = (): number => {
    for (let result = 0, shift = 0; ; shift += 7) {
      const byte = description[from++]!;
      result |= (byte & 0x7f) << shift;
      if (byte < 0x80) return result;
    }
  };
  const types = Array.from({ length: number() }, () => {
    const begin = from;
    const parameters = number();
    from += parameters;
    const results = number();
    from += results;
    return { parameters, encoded: description.subarray(begin, from) };
  });
  let place = 0;
  const runs = Array.from({ length: number() }, () => {
    const begin = place + number();
    place = begin + number();
    return { begin, end: place };
  });
  const functions = Uint16Array.from({ length: runs.reduce((sum, { begin, end }) => sum + end - begin, 0) }, number); // their types

  const out = new Uint8Array(most_bytes * (functions.length + types.length));
  let at = 0;
  const bytes = (all: ArrayLike<number>): void => {
    out.set(all, at);
    at += all.length;
  };
  const leb = (x: number): void => {
    for (; x >= 0x80; x >>= 7) out[at++] = (x & 0x7f) | 0x80;
    out[at++] = x;
  };
  const constant = (x: number): void => { // i32.const of a number below 2^20
    out[at++] = 0x41;
    out[at++] = (x & 0x7f) | 0x80;
    out[at++] = ((x >> 7) & 0x7f) | 0x80;
    out[at++] = x >> 14;
  };
  const section = (id: number, count: number, content: () => void): void => {
    out[at++] = id;
    const begin = at;
    at += 4; // for its length
    leb(count);
    content();
    const length = at - begin - 4;
    out.set([(length & 0x7f) | 0x80, ((length >> 7) & 0x7f) | 0x80, ((length >> 14) & 0x7f) | 0x80, length >> 21], begin);
  };
  bytes([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0]);
  section(1, types.length + 1, () => {
    for (const { encoded } of types) out[at++] = 0x60, bytes(encoded);
    bytes([0x60, 0, 0]);
  });
  section(2, 2, () => {
    bytes([1, 0x65, 1, 0x6c, 0]); // e.l, the function load
    leb(types.length);
    bytes([1, 0x65, 1, 0x74, 1, 0x70, 0, 0]); // e.t, the table
  });
  section(3, functions.length, () => functions.forEach(leb));
  let index = 0; // load
  section(9, runs.length, () => {
    for (const { begin, end } of runs) {
      out[at++] = 0;
      constant(begin);
      out[at++] = 0x0b;
      leb(end - begin);
      for (let k = begin; k < end; ++k) leb(++index);
    }
  });
  index = 0;
  section(10, functions.length, () => {
    for (const { begin, end } of runs) {
      for (let k = begin; k < end; ++k) {
        const type = functions[index++]!;
        const { parameters } = types[type]!;
        out[at++] = 10 + 2 * parameters + (type < 0x80 ? 1 : 2);
        out[at++] = 0; // no local variables
        out[at++] = 0x10; // call
        out[at++] = 0;
        for (let i = 0; i < parameters; ++i) out[at++] = 0x20, out[at++] = i; // local.get
        constant(k);
        out[at++] = 0x11; // call_indirect
        leb(type);
        out[at++] = 0;
        out[at++] = 0x0b;
      }
    }
  });
  return out.subarray(0, at);
}

/// Instantiates the first part. `rest` is called when a function of the rest is called for the first time.
export function instantiate(first: WebAssembly.Module, imports: WebAssembly.Imports, rest: () => WebAssembly.Module): WebAssembly.Instance {
  const instance = new WebAssembly.Instance(first, imports);
  const table = Object.values(instance.exports).find((each) => each instanceof WebAssembly.Table)!;
  const load = (): void => void new WebAssembly.Instance(rest(), { primary: instance.exports });
  const [description] = WebAssembly.Module.customSections(first, "placeholders");
  new WebAssembly.Instance(new WebAssembly.Module(placeholders(new Uint8Array(description!))), { e: { l: load, t: table } });
  return instance;
}
