// How the pages that examples write begin: in light or dark, as the reader's system has it.
#pragma once

#include <string>

inline constexpr const char* kPageStyle = R"(
:root { color-scheme: light dark; --ground: #f3f5f8; --card: #fff; --ink: #1b2733; --soft: #5c6b7a; --line: #dde3ea;
 --hulls: #4d4d4d; --smooth: #1f4e96; --start: #b0528f; --thing: #8a6410 }
@media (prefers-color-scheme: dark) { :root { --ground: #12171d; --card: #1b222b; --ink: #e4eaf1; --soft: #98a6b5;
 --line: #2e3944; --hulls: #c3cad2; --smooth: #6ba8f5; --start: #e58cc4; --thing: #d9a441 } }
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; max-width: 60em; margin: 1em auto; padding: 0 1em;
 color: var(--ink); background: var(--ground) }
h1 { font-size: 1.4em } h2 { font-size: 1.1em; margin: 1.5em 0 .4em } p { color: var(--soft) }
.chart { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 10px }
.chart svg { display: block; width: 100%; min-width: 600px; fill: currentColor }
table { border-collapse: collapse; font-variant-numeric: tabular-nums }
th, td { padding: 3px 10px; white-space: nowrap; text-align: right; border-bottom: 1px solid var(--line) }
:is(th, td):first-child { text-align: left }
)";

/// Up to the heading, which says what was found. What may be wider than a phone goes into a
/// `<div class="chart">`, which scrolls by itself. `style`: more CSS, for this page alone.
inline std::string pageHead(const std::string& found, const std::string& style = "") {
  return "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>" +
         found + "</title>\n<style>" + kPageStyle + style + "</style>\n<h1>" + found + "</h1>\n";
}
