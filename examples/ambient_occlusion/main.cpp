// Ambient occlusion by ray queries: for each pixel of a pinhole camera, the fraction of rays from the surface, sampled
// by their cosine, that reach a distance without hitting anything.

#include <alhazen/rays.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

struct Vector {
  float x, y, z;
};
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator*(Vector a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vector normalize(Vector a) { return a * (1 / std::sqrt(dot(a, a))); }

constexpr size_t width = 480, height = 360, samples = 64;

int main(int argc, char** argv) try {
  if (argc != 10) return std::fprintf(stderr, "usage: ambient_occlusion SCENE OUT.pgm EYE(3) AT(3) DISTANCE\n"), 2;
  float numbers[7];
  for (int i = 0; i < 7; ++i) numbers[i] = std::strtof(argv[3 + i], nullptr);
  const Vector eye{numbers[0], numbers[1], numbers[2]}, at{numbers[3], numbers[4], numbers[5]};

  const alhazen::RayQueries queries = alhazen::RayQueries::from_file(argv[1]);
  const Vector ahead = normalize(at + eye * -1), right = normalize(cross(ahead, {0, 1, 0})), up = cross(right, ahead);
  std::vector<Vector> directions;
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x)
      directions.push_back(ahead + right * ((static_cast<float>(x) + 0.5f - width / 2) / height) +
                           up * ((height / 2 - static_cast<float>(y) - 0.5f) / height));
  const size_t pixels = directions.size();
  alhazen::RayArrays<float> rays{&eye.x, &directions[0].x, pixels};
  rays.origin_stride = 0;  // all rays have the same
  std::vector<Vector> positions(pixels), normals(pixels);
  std::vector<float> t(pixels), offsets(pixels), light(pixels);
  alhazen::HitArrays<float> hits;
  hits.t = t.data();
  hits.positions = &positions[0].x;
  hits.normals = &normals[0].x;
  hits.offsets = offsets.data();
  queries.closest_hits(rays, hits);

  std::vector<uint8_t> occluded(pixels), image(pixels);
  alhazen::RayArrays<float> shadow{&positions[0].x, &directions[0].x, pixels, &numbers[6]};
  shadow.t_max_stride = 0;
  for (size_t i = 0; i < pixels; ++i) {
    if (dot(normals[i], directions[i]) > 0) normals[i] = normals[i] * -1;  // towards the camera
    positions[i] = positions[i] + normals[i] * offsets[i];
  }
  std::mt19937 random;
  std::uniform_real_distribution<float> uniform;
  for (size_t sample = 0; sample < samples; ++sample) {
    for (size_t i = 0; i < pixels; ++i) {
      const float z = 2 * uniform(random) - 1, phi = 2 * std::numbers::pi_v<float> * uniform(random);
      const float r = std::sqrt(1 - z * z);
      directions[i] = normalize(normals[i] * 1.0001f + Vector{r * std::cos(phi), r * std::sin(phi), z});
    }
    queries.occluded(shadow, occluded.data());
    for (size_t i = 0; i < pixels; ++i) light[i] += std::isinf(t[i]) || occluded[i] ? 0 : 1.0f / samples;
  }
  for (size_t i = 0; i < pixels; ++i)
    image[i] = static_cast<uint8_t>(255 * std::pow(std::min(light[i], 1.f), 1 / 2.2f));
  std::ofstream file(argv[2], std::ios::binary);
  file << "P5\n" << width << ' ' << height << "\n255\n";
  file.write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(pixels));
  if (!file.flush()) throw std::runtime_error(std::string(argv[2]) + " cannot be written");
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
