// @ts-check
// Where the picture is drawn: a thread of its own, so that the page answers while this one waits for
// the graphics card, or for the program in its place.
import { perform } from "./perform.js";

addEventListener("message", ({ data }) => perform(data.canvas, data.port), { once: true });
