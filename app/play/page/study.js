// A study: the texts before it, between two runs, and after the last run.

import { button, element } from "./dom.js";

/** Actions that are not possible in a study. */
export const BARRED = ["restart", "rewind", "handOver", "changeSeat", "rate", "showPlans", "next", "end", "menu"];

const paragraphs = (...texts) => texts.map((textContent) => element("p", { textContent }));

/** What is recorded and why. Without agreement nothing is recorded. */
function consent({ of, minutes }, send) {
  const agree = button({ words: "I have read this and take part", className: "primary" }, () => send("agree"));
  const parts = [
    element("h1", { textContent: "How do people drive among these drivers?" }),
    ...paragraphs(
      `You will drive a car in ${of} short runs of a simulation. Without pauses between them this takes ${Math.max(1, Math.round(minutes))} min.`,
      "Recorded are: what you do with pedals and wheel, and how all cars move. Not recorded are: your name, your address, the time of day, or anything else about you. You get a number.",
      "Participation is voluntary. You can stop at any time without a reason. A run that you do not finish is not recorded. If you tell your number to those who run this study, they can delete what you did.",
      "If you have questions, ask those who run the study before you begin."),
  ];
  return { parts, first: agree, buttons: [agree] };
}

function between({ participant, done, of }, send) {
  const next = button({ words: done ? "Next run" : "Begin", key: "Enter", className: "primary" }, () => send("next"));
  const stop = button({ words: "Stop here" }, () => send("leave"));
  const parts = [element("h1", { textContent: `${done} of ${of} runs are done` }), ...paragraphs(`You are number ${participant}. Take your time.`)];
  return { parts, first: next, buttons: [next, stop] };
}

function after({ participant }, send) {
  const next = button({ words: "Next participant", className: "primary" }, () => send("leave"));
  const parts = [element("h1", { textContent: "Thank you" }), ...paragraphs(`All runs are done. You are number ${participant}: with that number your data can be deleted.`)];
  return { parts, first: next, buttons: [next] };
}

/** The overlay of a stage of the study; `send(type)` sends the choice of the person to the server. */
export function studyView(place, send) {
  const shown = place.participant == null ? consent : place.done < place.of ? between : after;
  const { parts, first, buttons } = shown(place, send);
  return { made: element("section", { className: "card", role: "dialog", aria: { label: "The study" } }, parts, element("div", { className: "actions" }, buttons)), first };
}
