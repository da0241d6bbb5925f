// The scenario in the address: compressed TOML behind #s=, and the chosen columns. A link is a scenario.

export interface Shared {
  toml: string;
  x: string;
  y: string;
  z: string; // empty: the picture is plane
  method: string; // of the second motion; empty: there is none
}

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const piped = new Blob([bytes as BlobPart]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}

function to_letters(bytes: Uint8Array): string {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

function from_letters(letters: string): Uint8Array {
  const text = atob(letters.replaceAll("-", "+").replaceAll("_", "/"));
  return Uint8Array.from(text, (letter) => letter.charCodeAt(0));
}

export async function fragment_of(shared: Shared): Promise<string> {
  const bytes = await through(new TextEncoder().encode(shared.toml), new CompressionStream("deflate-raw"));
  const all = new URLSearchParams({ s: to_letters(bytes), x: shared.x, y: shared.y });
  if (shared.z !== "") all.set("z", shared.z);
  if (shared.method !== "") all.set("method", shared.method);
  return `#${all}`;
}

/// null: the address has no scenario, or a damaged one.
export async function shared_by(fragment: string): Promise<Shared | null> {
  const all = new URLSearchParams(fragment.replace(/^#/, ""));
  const letters = all.get("s");
  if (letters === null) return null;
  try {
    const bytes = await through(from_letters(letters), new DecompressionStream("deflate-raw"));
    return {
      toml: new TextDecoder("utf-8", { fatal: true }).decode(bytes),
      x: all.get("x") ?? "",
      y: all.get("y") ?? "",
      z: all.get("z") ?? "",
      method: all.get("method") ?? "",
    };
  } catch {
    return null;
  }
}
