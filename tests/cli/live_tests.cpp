// Seeing an image while it is rendered: --write-every, --tev, --terminal.

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <chrono>
#include <set>
#include <thread>

#include "cli/fixture.h"
#include "support/pseudo_terminal.h"
#include "support/tev_server.h"

namespace alhazen::impl::test {

namespace {

class Live : public Command {
 protected:
  void expect_refused(const std::vector<std::string>& arguments, const std::string& words) const {
    const CommandResult result = render(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_FALSE(exists("a.exr"));
  }

  double samples_of(const std::string& name) const {
    const Imf::InputFile file(folder_.file(name).c_str());
    const auto* samples = file.header().findTypedAttribute<Imf::StringAttribute>("samples");
    return samples ? std::stod(samples->value()) : -1;
  }
};

bool same_floats(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// A file that is looked at while it is written again and again is always whole, and has more and more samples.
TEST_F(Live, WriteEveryWritesWholeFilesWithMoreAndMoreSamples) {
  std::atomic<bool> is_over{false};
  std::vector<double> seen;
  std::thread reader([&] {
    while (!is_over) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (!exists("a.exr")) continue;
      const Image read = image("a.exr");  // throws if it is not whole
      EXPECT_EQ(read.width, 24);
      const double samples = samples_of("a.exr");
      if (seen.empty() || samples != seen.back()) seen.push_back(samples);
    }
  });
  const CommandResult result = render({"-o", "a.exr", "-o", "a.png", "--spp", "10000000", "--time-limit", "3",
                                       "--write-every", "0.05", "--aov", "depth", "--denoise", "builtin"});
  is_over = true;
  reader.join();
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_GE(seen.size(), 4u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_GT(seen.front(), 0);
  EXPECT_TRUE(exists("a.png"));
}

TEST_F(Live, WriteEveryLeavesTheImageSoFarWhereItIsKilled) {
  CommandOptions options;
  options.signal_when = [&](const std::string&) { return exists("a.exr") && exists("a.png") ? SIGKILL : 0; };
  const CommandResult result = render(
      {"-o", "a.exr", "-o", "a.png", "--spp", "10000000", "--write-every", "0.1", "--progress", "json"}, options);
  EXPECT_EQ(result.exit_code, 128 + SIGKILL) << result.everything();
  EXPECT_GT(samples_of("a.exr"), 0);
  EXPECT_EQ(image("a.png").width, 24);
}

TEST_F(Live, WriteEveryChangesNoBits) {
  ASSERT_EQ(render({"-o", "a.pfm", "--spp", "150"}).exit_code, 0);
  for (const std::vector<std::string>& engine :
       {std::vector<std::string>{"--backend", "serial"}, std::vector<std::string>{"--backend", "openmp"},
        std::vector<std::string>{"--backend", "cuda", "--device", "host"}}) {
    std::vector<std::string> arguments{"-o", "b.pfm", "--spp", "150", "--write-every", "0.01"};
    arguments.insert(arguments.end(), engine.begin(), engine.end());
    ASSERT_EQ(render(arguments).exit_code, 0);
    EXPECT_EQ(image("a.pfm").planes, image("b.pfm").planes) << engine[1];
  }
}

/// A limit on the size of files stands for a full disk: one warning, and the render goes on to its end.
TEST_F(Live, WriteEveryWarnsOnceOfAFailure) {
  CommandOptions options;
  options.file_size = 100;
  const CommandResult result =
      render({"-o", "a.exr", "--spp", "10000000", "--time-limit", "1.5", "--write-every", "0.05", "--progress", "none"},
             options);
  EXPECT_EQ(result.exit_code, 1) << result.everything();
  const std::string warning = "the image so far was not written, and the render goes on: ";
  const size_t first = result.err.find(warning);
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(warning, first + 1), std::string::npos) << result.err;
  EXPECT_FALSE(exists("a.exr"));
}

TEST_F(Live, WriteEveryIsForFilesOfOneImage) {
  expect_refused({"-o", "-", "--write-every", "1"}, "-o - writes one image");
  expect_refused({"-o", "a_##.exr", "--turntable", "3", "--write-every", "1"}, "--write-every is for one image");
  for (const char* wrong : {"0", "-1", "nan", "soon"})
    expect_refused({"-o", "a.exr", "--write-every", wrong}, "--write-every must be");
  CommandOptions options;
  options.folder = folder_.path();
  const CommandResult result = run_script(
      "mkfifo pipe.exr; cat pipe.exr >read.exr & $ALHAZEN render scene.pbrt -o pipe.exr --spp 200 --write-every 0.01; "
      "status=$?; wait; exit $status",
      options);
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("--write-every has no effect"), std::string::npos) << result.err;
  EXPECT_EQ(samples_of("read.exr"), 200) << "a reader of a pipe gets one image";
}

TEST_F(Live, TevGetsTheBitsOfTheFile) {
  TevServer server;
  const CommandResult result =
      render({"-o", "a.exr", "--spp", "64", "--exr-type", "float", "--aov", "albedo,normal,depth,samples,light_groups",
              "--transparent-background", "--tev", server.address()});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err.find("warning"), std::string::npos) << result.err;
  server.wait_for_end();
  const Image file = image("a.exr");
  server.with_images([&](const TevImages& tev) {
    ASSERT_TRUE(tev.images.contains("a.exr"));
    const Image& shown = tev.images.at("a.exr");
    EXPECT_EQ(std::set(shown.channels.begin(), shown.channels.end()),
              std::set(file.channels.begin(), file.channels.end()));
    for (size_t c = 0; c < shown.channels.size(); ++c)
      EXPECT_TRUE(same_floats(shown.planes[c], file.planes.at(static_cast<size_t>(file.channel(shown.channels[c])))))
          << shown.channels[c];
    EXPECT_EQ(tev.selected, "a.exr");
    EXPECT_EQ(tev.created.at("a.exr"), 1);
    EXPECT_GE(tev.finished.at("a.exr"), 2) << "while it renders, too";
  });
}

TEST_F(Live, TevGetsWhatIsDenoisedAndCroppedAndInterrupted) {
  TevServer server;
  CommandOptions options;
  options.signal_when = [](const std::string& err) {
    return err.find("\"samples_done\"") != std::string::npos ? SIGINT : 0;
  };
  EXPECT_EQ(render({"-o", "a.exr", "--spp", "10000000", "--progress", "json", "--exr-type", "float", "--crop",
                    "0.25,0.75,0,0.5", "--tev=" + server.address()},
                   options)
                .exit_code,
            130);
  EXPECT_EQ(
      render({"-o", "b.exr", "--spp", "8", "--exr-type", "float", "--denoise", "builtin", "--tev=" + server.address()})
          .exit_code,
      0);
  server.wait_for_end();
  for (const char* name : {"a.exr", "b.exr"}) {
    const Image file = image(name);
    server.with_images([&](const TevImages& tev) {
      const Image& shown = tev.images.at(name);
      ASSERT_EQ(shown.width, file.width);
      ASSERT_EQ(shown.height, file.height);
      for (const char* channel : {"R", "G", "B"})
        EXPECT_TRUE(same_floats(shown.planes.at(static_cast<size_t>(shown.channel(channel))),
                                file.planes.at(static_cast<size_t>(file.channel(channel)))))
            << name;
    });
  }
}

TEST_F(Live, TevGetsEachFrameUnderItsName) {
  TevServer server;
  ASSERT_EQ(
      render({"-o", "f_##.exr", "--turntable", "3", "--spp", "4", "--exr-type", "float", "--tev", server.address()})
          .exit_code,
      0);
  server.wait_for_end();
  for (const char* name : {"f_00.exr", "f_01.exr", "f_02.exr"}) {
    const Image file = image(name);
    server.with_images([&](const TevImages& tev) {
      ASSERT_TRUE(tev.images.contains(name));
      const Image& shown = tev.images.at(name);
      EXPECT_TRUE(same_floats(shown.planes[0], file.planes.at(static_cast<size_t>(file.channel(shown.channels[0])))));
    });
  }
  EXPECT_EQ(server.connections(), 1);
}

TEST_F(Live, ATevThatIsMissingIsOneWarning) {
  int port = 0;
  {
    const TevServer server;
    port = server.port();
  }
  const CommandResult result =
      render({"-o", "a.exr", "--spp", "10000000", "--time-limit", "1", "--tev", "localhost:" + std::to_string(port)});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  const size_t first = result.err.find("warning: tev at localhost");
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("warning", first + 1), std::string::npos) << result.err;
  EXPECT_LT(result.seconds, 10);
  EXPECT_TRUE(exists("a.exr"));
}

TEST_F(Live, ATevThatReadsNothingOrClosesDoesNotKeepTheRender) {
  for (const TevServer::Behaviour behaviour : {TevServer::Behaviour{.reads = false}, {.closes_after = 100'000}}) {
    TevServer server(behaviour);
    const CommandResult result = render({"-o", "a.exr", "--size", "400x400", "--aov", "albedo,normal,position,depth",
                                         "--spp", "10000000", "--time-limit", "2", "--tev", server.address()});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    EXPECT_LT(result.seconds, 15);
    EXPECT_TRUE(exists("a.exr"));
    std::filesystem::remove(folder_.file("a.exr"));
  }
}

TEST_F(Live, TevHasAnAddressOrTheOneOfItsProtocol) {
  for (const char* wrong : {"desk:0", "desk:99999", "[::1", ":"})
    expect_refused({"-o", "a.exr", std::string("--tev=") + wrong}, "--tev");
  // The word that follows is the scene, not the address.
  EXPECT_EQ(run({"render", "-o", "a.exr", "--spp", "1", "--tev", "scene.pbrt"}).exit_code, 0);
  EXPECT_TRUE(exists("a.exr"));
  folder_.write_text("options.toml", "tev = \"localhost:1\"\nwrite-every = 5\nspp = 1\n");
  const CommandResult result = render({"-o", "b.exr", "--config", "options.toml"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("tev at localhost:1"), std::string::npos) << result.err;
}

class LiveTerminal : public Live {
 protected:
  static constexpr int columns = 60, rows = 40;

  TerminalResult draw(std::vector<std::string> arguments, const std::function<void(pid_t, int)>& watch = {},
                      const std::string& locale = "C.UTF-8", const std::string& kind = "xterm-256color") {
    arguments.insert(arguments.begin(), {"render", "scene.pbrt"});
    return run_in_terminal(arguments, folder_.path(), {"TERM=" + kind, "LANG=" + locale, "ALHAZEN_TUNED="}, screen_,
                           columns, rows, watch);
  }

  /// The row of the screen at which the picture begins.
  size_t first_row(const std::string& character) const {
    for (size_t y = 0; y < screen_.cells().size(); ++y)
      if (screen_.cells()[y][0].character == character && screen_.cells()[y][0].back[0] >= 0) return y;
    ADD_FAILURE() << "no picture";
    return 0;
  }

  TerminalScreen screen_{columns, rows};
};

/// Bytes of a PNG of 8 bits.
TerminalScreen::Colour colour_of(const Image& png, int x, int y) {
  TerminalScreen::Colour colour;
  for (size_t c = 0; c < 3; ++c) {
    const auto linear = static_cast<double>(png.planes[c][static_cast<size_t>(y * png.width + x)]);
    colour[c] = static_cast<int>(std::lround(255 * srgb_encode(linear)));
  }
  return colour;
}

TEST_F(LiveTerminal, ShowsTheColoursOfThePng) {
  for (const std::vector<std::string>& display :
       {std::vector<std::string>{}, {"--exposure", "-1", "--tone-map", "aces"}, {"--exposure", "auto"}}) {
    std::vector<std::string> arguments{"-o", "a.png", "--spp", "64", "--terminal"};
    arguments.insert(arguments.end(), display.begin(), display.end());
    const TerminalResult result = draw(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.text;
    const Image png = image("a.png");
    const size_t top = first_row("\u2580");
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        const TerminalScreen::Cell& cell = screen_.cells()[top + static_cast<size_t>(y / 2)][static_cast<size_t>(x)];
        ASSERT_EQ(cell.character, "\u2580");
        const TerminalScreen::Colour shown = y % 2 == 0 ? cell.fore : cell.back, expected = colour_of(png, x, y);
        for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(shown[c], expected[c], 1) << x << " " << y;
      }
    EXPECT_EQ(screen_.cells()[top][24], TerminalScreen::Cell{}) << "no more than the image";
    EXPECT_NE(screen_.text_of(top + 12).find("100%"), std::string::npos) << "the bar is below";
    const size_t last = top + 13 + (display.empty() || display[1] != "auto" ? 0 : 1);  // what auto chose comes first
    EXPECT_NE(screen_.text_of(last).find("64 samples per pixel"), std::string::npos) << screen_.text_of(last);
    EXPECT_TRUE(screen_.shows_cursor());
    EXPECT_TRUE(screen_.has_own_colours());
    screen_ = TerminalScreen(columns, rows);
  }
}

TEST_F(LiveTerminal, IsDrawnAgainInItsPlaceAndFitted) {
  int drawn = 0;
  const TerminalResult result =
      draw({"-o", "a.png", "--size", "200x100", "--spp", "10000000", "--time-limit", "2", "--terminal"});
  ASSERT_EQ(result.exit_code, 0) << result.text;
  for (size_t at = result.text.find("\x1b[?25l"); at != std::string::npos; at = result.text.find("\x1b[?25l", at + 1))
    ++drawn;
  EXPECT_GE(drawn, 3);
  const size_t top = first_row("\u2580");
  EXPECT_LE(top, 1u) << "it has not scrolled";
  EXPECT_EQ(screen_.cells()[top][columns - 1].character, "\u2580") << "as wide as the terminal";
  EXPECT_EQ(screen_.cells()[top + 14][0].character, "\u2580") << "60 by 30 pixels";
  EXPECT_NE(screen_.cells()[top + 15][0].character, "\u2580");
}

TEST_F(LiveTerminal, FollowsTheSizeOfTheTerminal) {
  bool has_changed = false;
  const TerminalResult result =
      draw({"-o", "a.png", "--size", "200x100", "--spp", "10000000", "--time-limit", "3", "--terminal"},
           [&](pid_t, int terminal) {
             if (has_changed || screen_.cells()[0][5].character != "\u2580") return;
             has_changed = true;
             winsize size{};
             size.ws_col = 30;
             size.ws_row = 20;
             ioctl(terminal, TIOCSWINSZ, &size);
             screen_.resize(30, 20);
           });
  ASSERT_EQ(result.exit_code, 0) << result.text;
  EXPECT_TRUE(has_changed);
  EXPECT_EQ(screen_.cleared(), 1);
  EXPECT_EQ(screen_.cells()[0][29].character, "\u2580");
  EXPECT_EQ(screen_.cells()[6][29].character, "\u2580") << "30 by 15 pixels";
  EXPECT_NE(screen_.text_of(8).find("%"), std::string::npos) << screen_.text_of(8);
}

TEST_F(LiveTerminal, LeavesTheTerminalAsItWasAfterCtrlC) {
  for (const bool twice : {false, true}) {
    screen_ = TerminalScreen(columns, rows);
    int signals = 0;
    // A pipe without a reader keeps the program waiting, so that there is time for a second one.
    CommandOptions options;
    options.folder = folder_.path();
    run_script("rm -f p.exr; mkfifo p.exr", options);
    const TerminalResult result =
        draw({"-o", twice ? "p.exr" : "a.exr", "--spp", "10000000", "--terminal"}, [&](pid_t child, int) {
          if (signals > (twice ? 1 : 0) || screen_.cells()[0][0].character != "\u2580") return;
          ++signals;
          if (signals == 2) ::usleep(300'000);
          kill(child, SIGINT);
        });
    EXPECT_EQ(result.exit_code, 130) << result.text;
    EXPECT_TRUE(screen_.shows_cursor());
    EXPECT_TRUE(screen_.has_own_colours());
    EXPECT_EQ(result.text.find("interrupted") == std::string::npos, twice);
    EXPECT_EQ(exists("a.exr"), true);
  }
}

TEST_F(LiveTerminal, DrawsBlanksWithoutUtf8) {
  const TerminalResult result = draw({"-o", "a.png", "--spp", "4", "--terminal"}, {}, "C");
  ASSERT_EQ(result.exit_code, 0) << result.text;
  const size_t top = first_row(" ");
  EXPECT_GE(screen_.cells()[top + 11][23].back[0], 0);
  EXPECT_EQ(screen_.cells()[top + 11][24].back[0], -1);
  for (const char c : result.text) EXPECT_GE(c, 0);
}

TEST_F(LiveTerminal, IsAloneWithoutProgress) {
  for (const char* option : {"--quiet", "--progress=none"}) {
    screen_ = TerminalScreen(columns, rows);
    const TerminalResult result = draw({"-o", "a.png", "--spp", "16", "--terminal", option});
    ASSERT_EQ(result.exit_code, 0) << result.text;
    EXPECT_EQ(screen_.cells()[0][0].character, "\u2580");
    EXPECT_EQ(screen_.cells()[11][23].character, "\u2580");
    EXPECT_EQ(result.text.find('%'), std::string::npos);
  }
}

TEST_F(LiveTerminal, ShowsEachFrame) {
  const TerminalResult result = draw({"-o", "f_#.png", "--turntable", "2", "--spp", "4", "--terminal"});
  ASSERT_EQ(result.exit_code, 0) << result.text;
  std::vector<std::string> beginnings;
  for (size_t y = 0; y < screen_.cells().size(); ++y)
    if (const std::string text = screen_.text_of(y); !text.empty()) beginnings.push_back(text);
  const auto is_of_picture = [](const std::string& text) { return text.starts_with("\u2580"); };
  EXPECT_EQ(std::count_if(beginnings.begin(), beginnings.end(), is_of_picture), 24);
  const auto at = [&](const std::string& word) {
    return std::find_if(beginnings.begin(), beginnings.end(),
                        [&](const std::string& text) { return text.find(word) != std::string::npos; }) -
           beginnings.begin();
  };
  EXPECT_EQ(at("\u2580"), 0);
  EXPECT_EQ(at("frame 0 (1 of 2)"), 12) << "the bar of the first frame is below its picture";
  EXPECT_EQ(at("frame 1 (2 of 2)"), static_cast<ptrdiff_t>(beginnings.size()) - 3)
      << "its bar, and two lines of report";
}

TEST_F(LiveTerminal, NeedsATerminal) {
  expect_refused({"-o", "a.exr", "--terminal"}, "standard error is not one");
  const TerminalResult dumb = draw({"-o", "a.exr", "--terminal"}, {}, "C.UTF-8", "dumb");
  EXPECT_EQ(dumb.exit_code, 2);
  EXPECT_NE(dumb.text.find("TERM is 'dumb'"), std::string::npos) << dumb.text;
  for (const char* style : {"json", "plain"}) {
    const TerminalResult result = draw({"-o", "a.exr", "--terminal", "--progress", style});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.text.find("give --progress auto or none"), std::string::npos) << result.text;
  }
  EXPECT_FALSE(exists("a.exr"));
}

}  // namespace

}  // namespace alhazen::impl::test
