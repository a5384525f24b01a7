// Starts `interplay play` for the checks of its page.

import { spawn } from "node:child_process";
import { resolve } from "node:path";

/** Starts the server in a folder of its own; returns it with its address. */
export async function serve(binary, place, ...words) {
  const server = spawn(resolve(binary), ["play", ...words, "--no-browser", "--port", "0"], { cwd: place, stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise((found, refuse) => {
    let said = "";
    server.stdout.on("data", (piece) => {
      said += piece;
      const line = /http:\/\/127\.0\.0\.1:\d+\/[^\s/]+\//.exec(said);
      if (line) found(line[0]);
    });
    server.once("exit", (code) => refuse(new Error(`the server ended with exit code ${code}: ${said}`)));
    setTimeout(() => refuse(new Error(`no address after 20 s: ${said}`)), 20_000).unref();
  });
  return { server, address };
}
