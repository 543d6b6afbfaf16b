#include "cli/compare_page.h"

#include <fmt/format.h>

#include <string_view>

#include "cli/compare_limits.h"
#include "images/codecs/encode_png.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

std::string escape_html(const std::string& text) {
  std::string result;
  for (const char c : printable(text))
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

std::string base64_of(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string image_tag(const Image& image, const std::string& name, const char* css_class) {
  return fmt::format("<img class=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">",
                     css_class, escape_html(name), image.width, image.height, base64_of(encode_png(image)));
}

constexpr const char* head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>alhazen compare</title><style>
body { margin: 0 auto; padding: 12px; max-width: 1400px; font: 16px/1.4 system-ui, sans-serif; background: #fff;
  color: #222; }
h1 { font-size: 1.3em; overflow-wrap: anywhere; } h2 { font-size: 1.1em; }
img { max-width: 100%; height: auto; display: block; image-rendering: auto; }
.stage { position: relative; overflow: hidden; width: fit-content; max-width: 100%; }
.stage .over { position: absolute; inset: 0; width: 100%; height: 100%; }
.stage.sides { display: flex; flex-wrap: wrap; gap: 8px; overflow: visible; }
.stage.sides .over { position: static; width: auto; height: auto; clip-path: none !important; }
.stage.sides img { flex: 1 1 300px; min-width: 0; }
.heat { display: none; } .stage.map .heat { display: block; } .stage.map .under, .stage.map .over { display: none; }
input[type=range] { width: 100%; max-width: 600px; }
button { font: inherit; padding: 6px 10px; margin: 0 4px 6px 0; } button.on { background: #222; color: #fff; }
table { border-collapse: collapse; margin: 8px 0 24px; } td { padding: 2px 12px 2px 0; }
td + td { text-align: right; font-variant-numeric: tabular-nums; }
@media (prefers-color-scheme: dark) { body { background: #181818; color: #ddd; } button.on { background: #ddd;
  color: #222; } }
</style></head><body>
)";

constexpr const char* script = R"(<script>
for (const part of document.querySelectorAll('section')) {
  const stage = part.querySelector('.stage'), over = part.querySelector('.over');
  const slider = part.querySelector('input'), label = part.querySelector('.label');
  let timer = 0;
  const cut = () => { over.style.clipPath = 'inset(0 0 0 ' + slider.value + '%)'; };
  const show = mode => {
    clearInterval(timer);
    for (const button of part.querySelectorAll('button')) button.classList.toggle('on', button.value === mode);
    stage.className = 'stage ' + mode;
    slider.style.display = mode === 'slider' ? '' : 'none';
    label.textContent = mode === 'map' ? 'FLIP error: dark is equal, bright is different'
      : mode === 'sides' ? 'A, then B' : mode === 'slider' ? 'A is left of the slider, B right' : 'A';
    cut();
    if (mode !== 'flicker') return;
    let first = true;
    over.style.clipPath = 'inset(0 0 0 100%)';
    timer = setInterval(() => {
      first = !first;
      over.style.clipPath = first ? 'inset(0 0 0 100%)' : 'none';
      label.textContent = first ? 'A' : 'B';
    }, 600);
  };
  slider.addEventListener('input', cut);
  for (const button of part.querySelectorAll('button')) button.addEventListener('click', () => show(button.value));
  show('slider');
}
</script></body></html>
)";

std::string section(const ComparedPart& part) {
  std::string text = "<section>";
  if (!part.layer.empty()) text += "<h2>" + escape_html(part.layer) + "</h2>";
  text +=
      "\n<div><button value=\"slider\">Slider</button><button value=\"flicker\">Flicker</button>"
      "<button value=\"sides\">Side by side</button><button value=\"map\">Error</button></div>\n"
      "<div class=\"stage\">";
  text += image_tag(part.a, "A", "under") + image_tag(part.b, "B", "over") + image_tag(part.heat_map, "error", "heat");
  text +=
      "</div>\n<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"how much of A is shown\">"
      "<p class=\"label\"></p>\n<table>";
  for (const auto& [name, value] : measures_of(part.difference))
    text += fmt::format("<tr><td>{}</td><td>{:.6g}</td></tr>", name, value);
  return text + "</table></section>\n";
}

}  // namespace

std::string comparison_page(const std::string& a, const std::string& b, const std::vector<ComparedPart>& parts) {
  std::string page = head;
  page += "<h1>A: " + escape_html(a) + "<br>B, the reference: " + escape_html(b) + "</h1>\n";
  for (const ComparedPart& part : parts) page += section(part);
  return page + script;
}

}  // namespace alhazen::impl
