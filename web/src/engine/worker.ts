// The worker: one instance of the engine. It gets the compiled modules first, then requests, and answers each of them.
import hamflowEngine, { type EngineModule } from "hamflow-engine";
import type { Question, Reply } from "./protocol";

/// The first message: the part of the engine that motions need first, and where the rest is. The rest itself may follow.
export interface FirstPart {
  first: WebAssembly.Module;
  rest_at: string;
}

const scope = self as unknown as { onmessage: (event: MessageEvent) => void; postMessage(message: unknown, transfer: Transferable[]): void };
let engine: Promise<EngineModule>;
let rest: WebAssembly.Module | undefined;

/// The rest, at once: a function of it has been called.
function loaded_rest(address: string): WebAssembly.Module {
  const request = new XMLHttpRequest();
  request.open("GET", address, false);
  request.responseType = "arraybuffer";
  request.send();
  return new WebAssembly.Module(request.response as ArrayBuffer);
}

function start({ first, rest_at }: FirstPart): Promise<EngineModule> {
  let primary: WebAssembly.Exports | undefined;
  let is_whole = false;
  // A function of the rest stands in the table of functions; before the rest is there, a call goes through here.
  const placeholder = new Proxy({}, {
    get: (_, place: string) => (...args: unknown[]): unknown => {
      if (!is_whole) new WebAssembly.Instance(rest ??= loaded_rest(rest_at), { primary: primary! } as WebAssembly.Imports);
      is_whole = true;
      const table = Object.values(primary!).find((each) => each instanceof WebAssembly.Table) as WebAssembly.Table;
      return (table.get(Number(place)) as (...args: unknown[]) => unknown)(...args);
    },
  });
  return hamflowEngine({
    instantiateWasm(imports, done) {
      void WebAssembly.instantiate(first, { ...imports, placeholder }).then((instance) => {
        primary = instance.exports;
        done(instance, first);
      });
      return {};
    },
  });
}

/// Puts a text into the memory of the engine.
function stored(module: EngineModule, text: string): number {
  const bytes = module.lengthBytesUTF8(text) + 1;
  const address = module._malloc(bytes);
  module.stringToUTF8(text, address, bytes);
  return address;
}

function numbers(module: EngineModule, address: number, count: number): Float64Array {
  return module.HEAPF64.slice(address / 8, address / 8 + count);
}

function answer(module: EngineModule, request: Question): Reply {
  const texts: number[] = [];
  const args = request.args.map((arg) => {
    if (typeof arg === "number") return arg;
    texts.push(stored(module, arg));
    return texts[texts.length - 1]!;
  });
  const call = module[`_hamflow_${request.call}`] as (...args: number[]) => number;
  const json = module.UTF8ToString(call(request.motion, ...args));
  for (const text of texts) module._free(text);
  const response: Reply = { id: request.id, json, rows: null, points: null };
  if (json.startsWith('{"errors"')) return response;
  if (request.call === "open" || request.call === "show" || request.call === "advance") {
    response.rows = numbers(module, module._hamflow_rows(request.motion), module._hamflow_count(request.motion));
    response.points = numbers(module, module._hamflow_points(request.motion), module._hamflow_point_count(request.motion));
  } else if (request.call === "cells") {
    response.rows = numbers(module, module._hamflow_cell_numbers!(0), module._hamflow_cell_count!(0));
  } else if (request.call === "points_of_starts") {
    response.rows = numbers(module, module._hamflow_start_numbers!(0), module._hamflow_start_number_count!(0));
  }
  return response;
}

scope.onmessage = (event) => {
  if (event.data instanceof WebAssembly.Module) {
    rest = event.data;
    return;
  }
  if ("first" in event.data) {
    engine = start(event.data as FirstPart);
    return;
  }
  const request = event.data as Question;
  void engine.then((module) => {
    const response = answer(module, request);
    const transfer = [response.rows, response.points].filter((all) => all !== null).map((all) => all.buffer as ArrayBuffer);
    scope.postMessage(response, transfer);
  });
};
