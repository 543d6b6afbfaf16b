#pragma once

// The style sheet of the page, for light and dark screens and for paper.

namespace alhazen::impl::study {

inline constexpr const char* page_style = R"CSS(
:root { --ink: #1d2329; --soft: #5c6773; --line: #dfe4e9; --paper: #ffffff; --shade: #f5f7f9; --accent: #0b6e8f;
  --bar: #cfe6ee; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--shade); color: var(--ink); line-height: 1.5;
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 32px 24px 64px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 21px; margin: 0 0 8px; }
p { margin: 0 0 12px; max-width: 76ch; }
.above { color: var(--accent); font-weight: 600; margin: 0 0 8px; }
.facts { color: var(--soft); font-size: 13.5px; margin: 12px 0 0; padding: 0; list-style: none; }
h1, p, li, dd, figcaption { overflow-wrap: anywhere; }
section { min-width: 0; background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: 22px 24px; margin: 20px 0; }
.warning { border-left: 4px solid #d9762b; background: var(--paper); padding: 10px 14px; margin: 16px 0; max-width: none; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(190px, 1fr)); gap: 14px; margin: 20px 0; }
.card { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: 16px 18px; }
.card b { display: block; font-size: 28px; line-height: 1.15; color: var(--accent); }
.card span { color: var(--soft); font-size: 13.5px; }
dl { margin: 0; display: grid; grid-template-columns: max-content 1fr; gap: 8px 18px; }
dt { font-weight: 600; }
dd { margin: 0; min-width: 0; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: var(--soft); border-bottom: 2px solid var(--line); padding: 6px 10px; }
td { border-bottom: 1px solid var(--line); padding: 6px 10px; vertical-align: top; }
td.row { font-weight: 600; white-space: nowrap; }
td b { font-weight: 600; white-space: nowrap; }
td small, .notes { color: var(--soft); font-size: 12.5px; }
td small { display: block; }
td .speedup { display: inline-block; min-width: 4.2em; padding: 1px 6px; border-radius: 4px;
  background: linear-gradient(90deg, var(--bar) var(--filled), transparent var(--filled)); }
td.none b { color: var(--soft); font-weight: 400; }
td.doubt b, dd.withheld { color: var(--soft); font-style: italic; }
td.best b, td.best .speedup { color: var(--accent); font-weight: 700; }
.notes { margin: 10px 0 0; padding-left: 1.6em; }
figure { margin: 16px 0 0; }
figure img { max-width: 100%; height: auto; display: block; margin: 0 auto; background: #ffffff; border-radius: 6px; }
.drawing svg { max-width: 100%; height: auto; display: block; margin: 0 auto; border-radius: 6px; }
figcaption { color: var(--soft); font-size: 13px; margin-top: 6px; text-align: center; }
code { font: 13px ui-monospace, "DejaVu Sans Mono", monospace; background: var(--shade); padding: 1px 4px; border-radius: 4px; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e8ec; --soft: #9aa7b3; --line: #303841; --paper: #1a2027; --shade: #12161b; --accent: #63c1dd;
    --bar: #214754; }
}
@media (max-width: 640px) {
  dl { grid-template-columns: 1fr; }
  main { padding: 16px 10px; }
  section { padding: 16px 12px; }
  h1 { font-size: 24px; }
  .cards { grid-template-columns: 1fr 1fr; gap: 8px; }
  .card { padding: 10px 12px; }
  .card b { font-size: 22px; }
  td.row { white-space: normal; min-width: 8em; }
  th, td { padding: 6px; }
  figure { overflow-x: auto; }
  figure img, .drawing svg { max-width: none; width: 600px; }
}
@media print { body { background: #ffffff; } section { break-inside: avoid; } }
)CSS";

}  // namespace alhazen::impl::study
