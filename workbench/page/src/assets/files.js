// @ts-check
/** Opens files: sends them to the server, shows the proposed assignment, and opens the campaign. */
import { byId, element } from "./dom.js";
import { faultLines } from "./fault.js";
import { assignment, drawProposal } from "./mapping.js";
import { post, send } from "./server.js";

/** @typedef {{name: string, file: File}} Named */

/** Id of the upload on the server. */
let upload = "";

/** Counts the uploads, so that only the latest one is shown. */
let latest = 0;

/** Connects the controls. `opened` is called with the new campaign in the session.
 * @param {() => Promise<void>} opened */
export function connectFiles(opened) {
  byId("files").hidden = false;
  for (const [button, input] of [["files-choose", "files-input"], ["files-folder", "folder-input"]]) {
    const chooser = /** @type {HTMLInputElement} */ (byId(input));
    byId(button).addEventListener("click", () => chooser.click());
    chooser.addEventListener("change", () => {
      const files = [...chooser.files ?? []].map((file) => ({ name: file.webkitRelativePath || file.name, file }));
      chooser.value = "";
      if (files.length) receive(files);
    });
  }
  connectDrop();
  byId("files-discard").addEventListener("click", async () => {
    latest += 1;
    clear();
    await post("upload/discard", {}).catch(fail);
    byId("files-choose").focus();
  });
  byId("files-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    byId("files-fault").replaceChildren();
    working("Reading the files");
    try {
      const { notes } = /** @type {{ notes: string[] }} */ (await post("upload/open", { upload, ...assignment() }));
      clear();
      await opened();
      byId("files-title").focus();
      byId("files-status").replaceChildren("The campaign is open.", ...notes.map((note) => element("p", { class: "note" }, `${note}.`)));
    } catch (error) {
      fail(error);
    } finally {
      ready();
    }
  });
}

function connectDrop() {
  const isFile = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files");
  document.addEventListener("dragover", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    byId("files").dataset.over = "";
  });
  document.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) delete byId("files").dataset.over;
  });
  document.addEventListener("drop", async (event) => {
    delete byId("files").dataset.over;
    if (!isFile(event) || !event.dataTransfer) return;
    event.preventDefault();
    byId("files").scrollIntoView({ block: "nearest" });
    try {
      // The list is valid only during the event, so all entries are taken before the first wait.
      const items = [...event.dataTransfer.items].filter((item) => item.kind === "file");
      const dropped = items.map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
      const files = await Promise.all(dropped.map(({ entry, file }) => (entry ? filesOf(entry) : file ? [{ name: file.name, file }] : [])));
      await receive(files.flat());
    } catch (error) {
      fail(error);
    }
  });
}

/** The files of a dropped file or folder.
 * @param {FileSystemEntry} entry
 * @returns {Promise<Named[]>} */
async function filesOf(entry) {
  if (entry.isFile) {
    const single = /** @type {FileSystemFileEntry} */ (entry);
    /** @type {File} */
    const file = await new Promise((resolve, reject) => single.file(resolve, reject));
    return [{ name: entry.fullPath.replace(/^\//, ""), file }];
  }
  const reader = /** @type {FileSystemDirectoryEntry} */ (entry).createReader();
  /** @type {Named[]} */
  const files = [];
  for (;;) {
    // A part of the entries at a time; the last part is empty.
    /** @type {FileSystemEntry[]} */
    const part = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (part.length === 0) return files;
    files.push(...(await Promise.all(part.map(filesOf))).flat());
  }
}

/** Sends files, and shows the proposed assignment.
 * @param {Named[]} all */
async function receive(all) {
  const mine = ++latest;
  clear();
  // Hidden files of the system lie in many folders.
  const files = all.filter(({ file }) => !file.name.startsWith("."));
  working("Receiving the files");
  try {
    const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
    const started = (await post("upload/begin", { files: files.length, bytes })).upload;
    for (const [index, { name, file }] of files.entries()) {
      if (mine !== latest) return;
      working(`Receiving file ${index + 1} of ${files.length}: ${file.name}`);
      await send("upload/file", { upload: started, name }, file);
    }
    working("Reading the files");
    const proposal = await post("upload/survey", { upload: started });
    if (mine !== latest) return;
    upload = started;
    drawProposal(byId("files-proposal"), proposal);
    byId("files-form").hidden = false;
    byId("files-title").focus();
  } catch (error) {
    if (mine === latest) fail(error);
  } finally {
    if (mine === latest) ready();
  }
}

/** What is being done, as the status says it. */
let work = "";

/** @param {string} text */
function working(text) {
  work = text;
  byId("files-status").textContent = text;
  /** @type {HTMLButtonElement} */ (byId("files-open")).disabled = true;
}

function ready() {
  if (byId("files-status").textContent === work) byId("files-status").textContent = "";
  /** @type {HTMLButtonElement} */ (byId("files-open")).disabled = false;
}

function clear() {
  upload = "";
  byId("files-form").hidden = true;
  byId("files-proposal").replaceChildren();
  byId("files-fault").replaceChildren();
  byId("files-status").textContent = "";
}

/** @param {unknown} error */
function fail(error) {
  byId("files-fault").replaceChildren(...faultLines(error));
  byId("files-fault").scrollIntoView({ block: "nearest" });
}
