// @ts-check
/** The page that runs the closed loop without a server. */
import { connectLoop, followModel, redrawLoop } from "./closed_loop.js";
import { byId } from "./dom.js";
import { sayError } from "./message.js";
import { address, post, startModule } from "./module.js";

async function open() {
  try {
    await startModule(byId("module").textContent ?? "");
    connectLoop(sayError, { post, address });
    followModel({});
  } catch (error) {
    sayError(error);
  }
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawLoop);
open();
