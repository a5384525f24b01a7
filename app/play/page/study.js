// A study: what a person is told before it, between two runs, and after the last.

import { button, element } from "./dom.js";

/** What cannot be asked for in a study. */
export const BARRED = ["restart", "rewind", "handOver", "changeSeat", "rate", "showPlans", "next", "end", "menu"];

const paragraphs = (...texts) => texts.map((textContent) => element("p", { textContent }));

/** What is recorded and what it is for: without agreement nothing is. */
function consent({ of, minutes }, send) {
  const agree = button({ words: "I have read this, and take part", className: "primary" }, () => send("agree"));
  const parts = [
    element("h1", { textContent: "How do people drive among these drivers?" }),
    ...paragraphs(
      `You will drive a car in ${of} short runs of a simulation. Without pauses between them this takes ${Math.max(1, Math.round(minutes))} min.`,
      "Recorded are: what you do with pedals and wheel, and how all cars move. Not recorded are: your name, your address, the time of day, or anything else about you. You get a number.",
      "Taking part is up to you. You can stop at any time and need not say why. A run that you do not finish is not recorded. If you tell your number to those who run this study, they can delete what you did.",
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
  const next = button({ words: "Somebody else is next", className: "primary" }, () => send("leave"));
  const parts = [element("h1", { textContent: "Thank you" }), ...paragraphs(`All runs are done. You are number ${participant}: with that number what you did can be deleted.`)];
  return { parts, first: next, buttons: [next] };
}

/** The overlay of a place in the study; `send(type)` tells the server what the person wants. */
export function studyView(place, send) {
  const shown = place.participant == null ? consent : place.done < place.of ? between : after;
  const { parts, first, buttons } = shown(place, send);
  return { made: element("section", { className: "card", role: "dialog", aria: { label: "The study" } }, parts, element("div", { className: "actions" }, buttons)), first };
}
