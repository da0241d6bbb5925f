// Decodes what the page has inside, in a worker: megabytes of base64 and JSON would stop the page for a while.
import type { Inlined } from "../state/inlined";

/// "module": base64 of compressed WebAssembly; "bytes": base64 of other compressed bytes; "inlined": the JSON that `hamflow view` writes.
export interface DataQuestion {
  id: number;
  kind: "module" | "bytes" | "inlined";
  text: string;
}
export interface DataReply {
  id: number;
  module?: WebAssembly.Module;
  given?: Omit<Inlined, "rows">; // its rows are the bytes
  bytes: ArrayBuffer;
  error?: string; // why it cannot be decoded
}

const scope = self as unknown as { onmessage: (event: MessageEvent<DataQuestion>) => void; postMessage(message: DataReply, transfer: Transferable[]): void };

/// The browser decodes a data address much faster than a script does.
const decoded = (letters: string): Promise<Response> => fetch(`data:application/octet-stream;base64,${letters}`);

async function answer({ id, kind, text }: DataQuestion): Promise<DataReply> {
  if (kind !== "inlined") {
    const packed = await decoded(text.trim());
    const stream = packed.body!.pipeThrough(new DecompressionStream("gzip"));
    if (kind === "bytes") return { id, bytes: await new Response(stream).arrayBuffer() };
    const module = await WebAssembly.compileStreaming(new Response(stream, { headers: { "content-type": "application/wasm" } }));
    return { id, module, bytes: new ArrayBuffer(0) };
  }
  const { rows, ...given } = JSON.parse(text) as Inlined;
  return { id, given, bytes: await (await decoded(rows)).arrayBuffer() };
}

scope.onmessage = ({ data }) =>
  void answer(data)
    .catch((error: unknown): DataReply => ({ id: data.id, bytes: new ArrayBuffer(0), error: String(error) }))
    .then((reply) => scope.postMessage(reply, [reply.bytes]));
