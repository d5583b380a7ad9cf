"use strict";
(() => {
  const charts = () => document.querySelectorAll(".js-plotly-plot");
  // Names of rows above a chart make room on its left, and then the title of the axis below them may lie over its numbers.
  charts().forEach((chart) => {
    if (chart.layout.yaxis2) {
      Plotly.relayout(chart, { "yaxis.title.standoff": 8 });
    }
  });
  // A finger that passes over a chart scrolls the page; a pointer that drags zooms in.
  if (matchMedia("(pointer: coarse), (hover: none), (max-width: 48rem)").matches) {
    charts().forEach((chart) => Plotly.relayout(chart, { dragmode: false }));
  }
  // Paper has another width than the screen, and nothing on it can be opened.
  let opened = [];
  const paper = 690;
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not(.long):not([open])")];
    opened.forEach((data) => { data.open = true; });
    charts().forEach((chart) => {
      const half = chart.closest(".panels") !== null;
      Plotly.relayout(chart, { width: half ? (paper - 16) / 2 : paper, height: chart.clientHeight });
    });
  });
  addEventListener("afterprint", () => {
    opened.forEach((data) => { data.open = false; });
    charts().forEach((chart) => Plotly.relayout(chart, { width: null, height: null, autosize: true }));
  });
})();
