#include "study/figure1.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

namespace alhazen::impl::study {

namespace {

/// A point or direction of the drawing, in its pixels, y down.
struct Vec {
  double x = 0, y = 0;
};

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
Vec operator*(double s, Vec a) { return {s * a.x, s * a.y}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
Vec unit(Vec a) { return 1 / std::sqrt(dot(a, a)) * a; }

struct Circle {
  Vec centre;
  double radius;
  Vec normal(Vec at) const { return unit(at - centre); }
};

constexpr int figure_width = 720, figure_height = 400;
constexpr double ground = 352;
constexpr Vec camera{62, 222};
constexpr Circle light{{292, 52}, 20}, diffuse{{372, 296}, 56}, mirror{{478, 118}, 44}, glass{{540, 268}, 56};
constexpr double glass_ior = 1.5;
constexpr const char *ink = "#1d2329", *soft = "#5c6773", *blue = "#0b6e8f", *orange = "#d9762b", *green = "#4c8c4a";

/// Where a ray of unit direction reaches a circle, from outside or, beyond its start, from inside.
std::optional<Vec> hit(Vec start, Vec direction, const Circle& circle) {
  constexpr double min_distance = 1e-6;
  const Vec from_centre = start - circle.centre;
  const double b = dot(from_centre, direction);
  const double discriminant = b * b - dot(from_centre, from_centre) + circle.radius * circle.radius;
  if (discriminant < 0) return std::nullopt;
  for (const double t : {-b - std::sqrt(discriminant), -b + std::sqrt(discriminant)})
    if (t > min_distance) return start + t * direction;
  return std::nullopt;
}

Vec reflect(Vec direction, Vec normal) { return direction - 2 * dot(direction, normal) * normal; }

/// By Snell's law, without total reflection; `normal` is on the side that the ray comes from.
Vec refract(Vec direction, Vec normal, double ior_ratio) {
  const double cosine = -dot(direction, normal);
  const double sine_squared = ior_ratio * ior_ratio * (1 - cosine * cosine);
  return ior_ratio * direction + (ior_ratio * cosine - std::sqrt(1 - sine_squared)) * normal;
}

/// Where a ray that goes down reaches the ground.
Vec on_ground(Vec start, Vec direction) { return start + (ground - start.y) / direction.y * direction; }

std::string line(Vec from, Vec to, const std::string& style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", from.x, from.y, to.x, to.y,
                     style);
}

std::string circle(const Circle& c, const std::string& style) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", c.centre.x, c.centre.y, c.radius,
                     style);
}

std::string text(Vec at, const char* anchor, const char* colour, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", at.x, at.y, anchor,
                     colour, words);
}

/// A segment of a path with its number; `is_other` is one that the path could have taken instead.
std::string segment(Vec from, Vec to, const char* colour, bool is_other = false) {
  return line(from, to,
              fmt::format("stroke=\"{0}\" stroke-width=\"2\" marker-end=\"url(#{1})\"{2}", colour, colour + 1,
                          is_other ? " stroke-dasharray=\"5 4\"" : ""));
}

std::string number(Vec from, Vec to, const char* colour, int n) {
  const Vec middle = 0.5 * (from + to);
  return circle({middle, 8.5}, fmt::format("fill=\"#ffffff\" stroke=\"{}\"", colour)) +
         text(middle + Vec{0, 4}, "middle", colour, std::to_string(n));
}

std::string arrowheads() {
  std::string defs = "<defs>\n";
  for (const char* colour : {blue, orange, green})
    defs += fmt::format(
        "<marker id=\"{0}\" viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" markerWidth=\"6\" markerHeight=\"6\" "
        "orient=\"auto\"><path d=\"M0 0L10 5L0 10z\" fill=\"#{0}\"/></marker>\n",
        colour + 1);
  return defs +
         "<radialGradient id=\"ball\" cx=\"0.36\" cy=\"0.3\" r=\"0.8\"><stop offset=\"0\" stop-color=\"#ffffff\"/>"
         "<stop offset=\"1\" stop-color=\"#b9c4cc\"/></radialGradient>\n</defs>\n";
}

/// The image between the camera and the scene, a grid of pixels in perspective.
std::string image_grid() {
  constexpr int columns = 6, rows = 7;
  constexpr Vec corner{150, 138}, across{62, -30}, down{0, 168};
  std::string svg;
  const std::string style = fmt::format("stroke=\"{}\" stroke-width=\"1\"", soft);
  for (int i = 0; i <= columns; ++i) {
    const Vec top = corner + static_cast<double>(i) / columns * across;
    svg += line(top, top + down, style);
  }
  for (int i = 0; i <= rows; ++i) {
    const Vec left = corner + static_cast<double>(i) / rows * down;
    svg += line(left, left + across, style);
  }
  return svg;
}

std::string objects() {
  std::string svg = fmt::format(
      "<rect x=\"0\" y=\"{0}\" width=\"{1}\" height=\"{2}\" fill=\"#e9edf0\"/>\n<line x1=\"0\" y1=\"{0}\" x2=\"{1}\" "
      "y2=\"{0}\" stroke=\"#98a4af\"/>\n",
      ground, figure_width, figure_height - ground);
  svg += circle(diffuse, "fill=\"#f0c9a6\" stroke=\"#d9762b\"");
  svg += circle(mirror, "fill=\"url(#ball)\" stroke=\"#5c6773\"");
  svg += circle(glass, "fill=\"#dcecf2\" stroke=\"#0b6e8f\"");
  svg += circle(light, "fill=\"#ffd95e\" stroke=\"#c79a1c\"");
  for (int i = 0; i < 12; ++i) {
    const double angle = i * std::acos(-1.0) / 6;
    const Vec direction{std::cos(angle), std::sin(angle)};
    svg += line(light.centre + (light.radius + 4) * direction, light.centre + (light.radius + 11) * direction,
                "stroke=\"#c79a1c\" stroke-width=\"2\"");
  }
  return svg;
}

/// A path that a diffuse sphere scatters to the light.
std::string diffuse_path() {
  const Vec first = unit(Vec{340, 256} - camera);
  const Vec at = *hit(camera, first, diffuse);
  const Vec end = *hit(at, unit(light.centre - at), light);
  std::string svg;
  // Directions that the path could have taken.
  for (const double angle : {-0.3, 0.25, 1.35}) {
    const Vec n = diffuse.normal(at);
    const Vec direction{n.x * std::cos(angle) - n.y * std::sin(angle), n.x * std::sin(angle) + n.y * std::cos(angle)};
    svg += segment(at, at + 34 * direction, orange, true);
  }
  return svg + segment(camera, at, orange) + segment(at, end, orange) +
         number(camera + 0.55 * (at - camera), at, orange, 1) + number(at, end, orange, 2);
}

/// A path that a mirror reflects and that escapes.
std::string mirror_path() {
  const Vec first = unit(Vec{447, 98} - camera);
  const Vec at = *hit(camera, first, mirror);
  const Vec direction = reflect(first, mirror.normal(at));
  const Vec end = at + (18 - at.y) / direction.y * direction;
  return segment(camera, at, green) + segment(at, end, green) + number(camera + 0.5 * (at - camera), at, green, 1) +
         number(at, end, green, 2);
}

/// A path that glass refracts twice and that reaches the ground; the one that it could have reflected is dashed.
std::string glass_path() {
  const Vec first = unit(Vec{508, 222} - camera);
  const Vec in = *hit(camera, first, glass);
  const Vec inside = unit(refract(first, glass.normal(in), 1 / glass_ior));
  const Vec out = *hit(in, inside, glass);
  const Vec last = unit(refract(inside, -1.0 * glass.normal(out), glass_ior));
  const Vec end = last.y > 0 ? on_ground(out, last) : out + 80 * last;
  return segment(in, in + 60 * reflect(first, glass.normal(in)), blue, true) + segment(camera, in, blue) +
         segment(in, out, blue) + segment(out, end, blue) + number(camera + 0.7 * (in - camera), in, blue, 1) +
         number(in, out, blue, 2) + number(out, end, blue, 3);
}

std::string labels() {
  return text({34, 262}, "start", ink, "camera") + text({150, 328}, "start", ink, "image:") +
         text({150, 345}, "start", ink, "H x W pixels") + text(light.centre + Vec{40, 4}, "start", ink, "light") +
         text(diffuse.centre + Vec{4, 22}, "middle", ink, "diffuse") +
         text(mirror.centre + Vec{52, -8}, "start", ink, "specular (mirror)") +
         text(glass.centre + Vec{62, -34}, "start", ink, "dielectric") +
         text(glass.centre + Vec{62, -17}, "start", ink, "(glass)") +
         text({12, 384}, "start", soft,
              "1, 2, 3: segments of a path, at most D. S paths start in every pixel. Dashed: other directions it could "
              "take.");
}

}  // namespace

std::string figure1_svg() {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "font-family=\"system-ui, 'DejaVu Sans', sans-serif\" font-size=\"13\">\n<title>{2}</title>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      figure_width, figure_height, figure1_text());
  svg += arrowheads() + objects() + image_grid() + glass_path() + mirror_path() + diffuse_path();
  svg += fmt::format(
      "<path d=\"M{0} {1}l-26 -15v30z\" fill=\"{2}\"/><circle cx=\"{0}\" cy=\"{1}\" r=\"5\" "
      "fill=\"#ffffff\" stroke=\"{2}\" stroke-width=\"2\"/>\n",
      camera.x, camera.y, ink);
  return svg + labels() + "</svg>\n";
}

std::string figure1_text() {
  return "A ray tracing problem: rays start at the camera, through the pixels of the image, and bounce among the "
         "objects until they reach a light, escape, or have D segments. A diffuse surface scatters in any direction, a "
         "specular one reflects in one, and a dielectric one reflects or refracts.";
}

}  // namespace alhazen::impl::study
