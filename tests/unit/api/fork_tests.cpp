// The library in a process that was forked after threads have worked.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

#include "alhazen/rays.h"
#include "alhazen/scene.h"

namespace {

struct Results {
  std::vector<float> t;
  std::vector<std::vector<float>> planes;
  bool operator==(const Results&) const = default;
};

/// Both start teams of OpenMP on this thread.
Results work(const alhazen::Scene& scene, const alhazen::RayQueries& queries) {
  constexpr size_t count = 10000;
  Results results{std::vector<float>(count), {}};
  std::vector<float> origins(3 * count), directions{0, 0, 1};
  for (size_t i = 0; i < origins.size(); ++i)
    origins[i] = i % 3 == 2 ? -3.0f : static_cast<float>(i) / static_cast<float>(origins.size());
  alhazen::RayArrays<float> rays{origins.data(), directions.data(), count};
  rays.direction_stride = 0;
  alhazen::HitArrays<float> hits;
  hits.t = results.t.data();
  queries.closest_hits(rays, hits, 2);
  alhazen::Settings settings;
  settings.threads = 2;
  settings.samples_per_pixel = 4;
  settings.width = settings.height = 64;
  results.planes = alhazen::render(scene, settings).planes;
  return results;
}

TEST(Fork, AChildWorksLikeItsParent) {
  alhazen::Scene scene;
  scene.add(alhazen::Shape{alhazen::Sphere{}, scene.add(alhazen::Diffuse{})});
  const alhazen::RayQueries queries(scene);
  const Results here = work(scene, queries);
  const pid_t child = ::fork();
  ASSERT_NE(child, -1);
  if (child == 0) {
    ::alarm(60);  // rather than to wait forever
    ::_exit(work(scene, queries) == here ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(work(scene, queries), here);
}

}  // namespace
