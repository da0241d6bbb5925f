// The module that emscripten makes of web/engine.
declare module "hamflow-engine" {
  export interface EngineModule {
    HEAPF64: Float64Array;
    UTF8ToString(address: number): string;
    stringToUTF8(text: string, address: number, bytes: number): void;
    lengthBytesUTF8(text: string): number;
    _malloc(bytes: number): number;
    _free(address: number): void;
    _hamflow_rows(motion: number): number;
    _hamflow_count(motion: number): number;
    _hamflow_points(motion: number): number;
    _hamflow_point_count(motion: number): number;
    [name: `_hamflow_${string}`]: (...args: number[]) => number;
  }
  export interface Hooks {
    instantiateWasm(imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void): object;
  }
  export default function hamflowEngine(hooks: Hooks): Promise<EngineModule>;
}

/// The bundled source of worker.ts (build.mjs).
declare module "worker-source" {
  const source: string;
  export default source;
}

/// The bundled source of data_worker.ts (build.mjs).
declare module "data-worker-source" {
  const source: string;
  export default source;
}

/// The files *.toml of src/gallery in the order of their names (build.mjs).
declare module "gallery-files" {
  export const files: { name: string; heads: Record<string, string>; toml: string }[];
}

/// The views of src/views in the order of their names (build.mjs).
declare module "all-views" {
  export const views: import("../view").MakeView[];
}
