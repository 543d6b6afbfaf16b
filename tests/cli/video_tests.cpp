// MP4 and GIF, which ffmpeg encodes; stand-ins for it show what it is given.

#include <csignal>
#include <cstdlib>

#include "cli/fixture.h"
#include "support/animated_gltf.h"

namespace alhazen::impl::test {

namespace {

class Video : public Command {
 protected:
  Video() { write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {-1, 0, 0, 1, 0, 0}}}); }

  /// Runs with these programs alone on PATH; `script` is a stand-in for ffmpeg, empty: there is none.
  CommandResult with_stand_in(const std::string& script, const std::string& arguments) const {
    std::filesystem::create_directory(folder_.file("bin"));
    std::filesystem::remove(folder_.file("bin/ffmpeg"));
    if (!script.empty()) {
      folder_.write_text("bin/ffmpeg", "#!/bin/sh\n" + script);
      std::filesystem::permissions(folder_.file("bin/ffmpeg"), std::filesystem::perms::owner_all);
    }
    CommandOptions options;
    options.folder = folder_.path();
    return run_script("PATH=" + folder_.file("bin") +
                          " $ALHAZEN render moving.gltf --size 16x16 --spp 1 --progress none " + arguments,
                      options);
  }

  static bool has_ffmpeg() { return std::system("command -v ffmpeg ffprobe > /dev/null 2>&1") == 0; }

  /// What ffprobe says of a video: width, height, rate, frames.
  std::string probed(const std::string& name) const {
    const CommandResult result =
        run_command({"/usr/bin/env", "ffprobe", "-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                     "stream=width,height,r_frame_rate,nb_read_frames", "-of", "csv=p=0", folder_.file(name)});
    return lines_of(result.out).empty() ? result.err : lines_of(result.out)[0];
  }

  bool has_temporary() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (entry.path().filename().string().starts_with(".alhazen")) return true;
    return false;
  }
};

/// The frames as they come, three bytes a pixel; the last argument is the file to write.
const std::string stand_in =
    "for last; do :; done\nfile=${last#file:}\n/bin/cat > \"$file\"\necho \"$@\" > arguments\n";

TEST_F(Video, ReceivesEveryFrameAsThePngHasIt) {
  const CommandResult result =
      with_stand_in(stand_in, "--frames 0..4:2 --fps 12 -o 'a b;$x.mp4' -o f_#.png --exposure 0");
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("wrote a b;$x.mp4 of 3 frames"), std::string::npos) << result.err;
  const Bytes video = read_file(folder_.file("a b;$x.mp4"));
  ASSERT_EQ(video.size(), 3u * 16 * 16 * 3);
  for (size_t f = 0; f < 3; ++f) {
    const Image frame = image("f_" + std::to_string(2 * f) + ".png");
    for (size_t i = 0; i < 16 * 16; ++i)
      EXPECT_EQ(static_cast<int>(std::floor(255 * srgb_encode(static_cast<double>(frame.planes[1][i])) + 0.5)),
                video[(f * 16 * 16 + i) * 3 + 1]);
  }
  const Bytes said = read_file(folder_.file("arguments"));
  const std::string arguments(said.begin(), said.end());
  EXPECT_NE(arguments.find("-s 16x16 -framerate 6 "), std::string::npos)
      << "every second frame of 12 in a second" << arguments;
  EXPECT_FALSE(has_temporary());
}

/// Frames that are there are read back, and the video is the same as before.
TEST_F(Video, IsMadeOfFramesThatAreThere) {
  ASSERT_EQ(with_stand_in(stand_in, "--frames 0..3 -o v.mp4 -o f_#.png").exit_code, 0);
  const Bytes video = read_file(folder_.file("v.mp4"));
  std::filesystem::remove(folder_.file("f_2.png"));
  std::filesystem::remove(folder_.file("v.mp4"));
  const CommandResult resumed = with_stand_in(stand_in, "--frames 0..3 -o v.mp4 -o f_#.png");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.everything();
  EXPECT_NE(resumed.err.find("3 of 4 frames are there"), std::string::npos) << resumed.err;
  EXPECT_EQ(read_file(folder_.file("v.mp4")), video);
  std::filesystem::remove(folder_.file("v.mp4"));
  ASSERT_EQ(with_stand_in(stand_in, "--frames 0..3 -o v.mp4 -o f_#.png").exit_code, 0);
  EXPECT_EQ(read_file(folder_.file("v.mp4")), video) << "with no frame left to render";
}

TEST_F(Video, NeedsFfmpegBeforeAnythingIsRendered) {
  const CommandResult result = with_stand_in("", "--frames 0..3 -o v.mp4 -o f_#.png");
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_NE(result.err.find("apt-get install ffmpeg"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("f_0.png"));
}

TEST_F(Video, SaysWhatFfmpegSaidWhenItFails) {
  folder_.write_text("v.mp4", "an older one");
  for (const std::string script : {"echo one >&2; echo the codec is missing >&2; exit 3",
                                   "/bin/cat > /dev/null; echo the codec is missing >&2; exit 3"}) {
    const CommandResult result = with_stand_in(script, "--frames 0..3 -o v.mp4");
    EXPECT_EQ(result.exit_code, 1) << result.everything();
    EXPECT_NE(result.err.find("cannot write v.mp4: ffmpeg"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("\n  the codec is missing"), std::string::npos) << result.err;
  }
  const Bytes kept = read_file(folder_.file("v.mp4"));
  EXPECT_EQ(std::string(kept.begin(), kept.end()), "an older one");
  EXPECT_FALSE(has_temporary());
}

/// ffmpeg ends with 0 where the disk is full, and says so; an older video is better than a broken one.
TEST_F(Video, KeepsTheOlderOneWhereFfmpegFails) {
  const std::string no_space = "echo 'av_interleaved_write_frame(): No space left on device' >&2\n";
  for (const auto& [script, words] :
       {std::pair<std::string, std::string>{"/bin/cat > /dev/null; exit 0", "ffmpeg has written nothing"},
        {stand_in + no_space, "No space left on device: free some space"},
        {stand_in + no_space + "exit 1", "No space left on device: free some space"},
        {stand_in + "echo odd >&2", "ffmpeg reports an error; it says:\n  odd"},
        {stand_in + "kill -9 $$", "ffmpeg was ended by signal 9 (Killed)"},
        {"exit 3", "ffmpeg ended with exit code 3"}})
    for (const std::string name : {"v.mp4", "v.gif"}) {
      folder_.write_text(name, "an older one");
      const CommandResult result = with_stand_in(script, "--frames 0..3 -o " + name);
      EXPECT_EQ(result.exit_code, 1) << result.everything();
      EXPECT_NE(result.err.find("cannot write " + name + ": " + words), std::string::npos) << result.err;
      EXPECT_EQ(read_file(folder_.file(name)).size(), 12u) << script;
      EXPECT_FALSE(has_temporary());
    }
}

TEST_F(Video, OverALimitOnTheSizeOfFilesIsASentence) {
  with_stand_in("for last; do :; done\nfile=${last#file:}\nexec /bin/cat > \"$file\"\n", "--frames 0 -o unused_#.png");
  CommandOptions options;
  options.folder = folder_.path();
  options.file_size = 4096;
  const CommandResult result =
      run_script("PATH=" + folder_.file("bin") +
                     " exec $ALHAZEN render moving.gltf --size 64x64 --spp 1 --progress none --frames 0..3 -o v.mp4",
                 options);
  EXPECT_EQ(result.exit_code, 1) << result.everything();
  EXPECT_NE(result.err.find("ulimit -f"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("v.mp4"));
  EXPECT_FALSE(has_temporary());
}

/// Neither by a symbolic nor by a hard link, also where no frame is left to render.
TEST_F(Video, ReplacesNothingThatItIsMadeOf) {
  ASSERT_EQ(with_stand_in(stand_in, "--frames 0..2 -o f_#.png").exit_code, 0);
  for (const std::string input : {"f_1.png", "moving.gltf", "moving.bin"})
    for (const bool is_hard : {false, true})
      for (const std::string frames : {"0..2", "0..3"}) {
        const Bytes before = read_file(folder_.file(input));
        std::filesystem::remove(folder_.file("v.mp4"));
        if (is_hard)
          std::filesystem::create_hard_link(folder_.file(input), folder_.file("v.mp4"));
        else
          std::filesystem::create_symlink(input, folder_.file("v.mp4"));
        const CommandResult result = with_stand_in(stand_in, "--frames " + frames + " -o v.mp4 -o f_#.png");
        EXPECT_EQ(result.exit_code, 2) << input << frames << result.everything();
        EXPECT_NE(result.err.find("the output is the same file as "), std::string::npos) << result.err;
        EXPECT_EQ(read_file(folder_.file(input)), before) << input << frames;
      }
}

/// A video is premultiplied by alpha, so its frames are rendered again, and their files are not written.
TEST_F(Video, OfATransparentBackgroundLeavesFramesAsTheyAre) {
  const std::string arguments = "--frames 0..2 --transparent-background -o v.mp4 -o f_#.png";
  ASSERT_EQ(with_stand_in(stand_in, arguments).exit_code, 0);
  const Bytes video = read_file(folder_.file("v.mp4"));
  folder_.write_text("f_1.png", "mine");
  std::filesystem::remove(folder_.file("f_2.png"));
  const CommandResult again = with_stand_in(stand_in, arguments);
  EXPECT_EQ(again.exit_code, 0) << again.everything();
  EXPECT_NE(again.err.find("2 of 3 frames are there and are left as they are"), std::string::npos) << again.err;
  EXPECT_EQ(read_file(folder_.file("f_1.png")).size(), 4u);
  EXPECT_EQ(read_file(folder_.file("v.mp4")), video);
  EXPECT_TRUE(exists("f_2.png"));
  EXPECT_EQ(with_stand_in(stand_in, arguments + " --overwrite").exit_code, 0);
  EXPECT_NO_THROW(image("f_1.png"));
}

TEST_F(Video, AGifPlaysAtARateThatPlayersKeep) {
  const auto rendered = [&](const std::string& arguments) {
    const CommandResult result = with_stand_in(stand_in, "--frames 0..1 -o v.gif " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    const Bytes said = read_file(folder_.file("arguments"));
    return std::pair(result.err, std::string(said.begin(), said.end()));
  };
  const auto [err, arguments] = rendered("--fps 60");
  EXPECT_NE(err.find("warning: v.gif: it plays at 50 frames per second, not at 60"), std::string::npos) << err;
  EXPECT_NE(arguments.find("-framerate 50 "), std::string::npos) << arguments;
  const auto [kept, same] = rendered("--fps 24");
  EXPECT_EQ(kept.find("warning: v.gif"), std::string::npos) << kept;
  EXPECT_NE(same.find("-framerate 24 "), std::string::npos) << same;
  const auto [slow, slowest] = rendered("--fps 0.001");
  EXPECT_NE(slow.find("warning: v.gif: it plays at 0.0015259 frames"), std::string::npos) << slow;
  EXPECT_NE(slowest.find("-framerate 0.00152590"), std::string::npos) << slowest;
}

TEST_F(Video, RefusesWhatMakesNoVideo) {
  for (const std::string arguments :
       {"-o v.mp4", "-o v.gif", "--frames 0..3 -o none/v.mp4", "--frames 0..3 -o v.avi"}) {
    const CommandResult result = with_stand_in(stand_in, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.everything();
  }
  EXPECT_FALSE(exists("v.mp4") || exists("v.gif"));
}

TEST_F(Video, OfAnInterruptedRunHasTheFinishedFrames) {
  with_stand_in(stand_in, "--frames 0 -o unused_#.png");
  CommandOptions options;
  options.folder = folder_.path();
  options.signal_when = [](const std::string& err) {
    return err.find("frame 1 (2 of") != std::string::npos ? SIGINT : 0;
  };
  const CommandResult result = run_script(
      "PATH=" + folder_.file("bin") +
          " exec $ALHAZEN render moving.gltf --size 64x64 --spp 256 --progress none --frames 0..999 -o v.mp4",
      options);
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  const Bytes video = read_file(folder_.file("v.mp4"));
  EXPECT_GE(video.size(), 2u * 64 * 64 * 3);
  EXPECT_EQ(video.size() % (64 * 64 * 3), 0u) << "whole frames";
  EXPECT_FALSE(has_temporary());
}

/// One Ctrl-C ends it, whether it takes no frames or does not come to its end.
TEST_F(Video, AHungFfmpegIsEndedByAnInterrupt) {
  const std::string hung = "echo $$ > pid\n";
  for (const std::string& script :
       {hung + "exec /bin/sleep 1000", hung + "/bin/cat > /dev/null; exec /bin/sleep 1000"}) {
    with_stand_in(script, "--frames 0 -o unused_#.png");
    CommandOptions options;
    options.folder = folder_.path();
    options.signal_when = [](const std::string& err) {
      return err.find("frame 2 (3 of") != std::string::npos ? SIGINT : 0;
    };
    // 64 KiB of a pipe hold the first two frames.
    const CommandResult result = run_script(
        "PATH=" + folder_.file("bin") +
            " exec $ALHAZEN render moving.gltf --size 100x100 --spp 1 --progress none --frames 0..2 -o v.mp4",
        options);
    EXPECT_EQ(result.exit_code, 130) << result.everything();
    EXPECT_NE(result.err.find("interrupted: ffmpeg stood still and was ended, and v.mp4 is not written"),
              std::string::npos)
        << result.err;
    EXPECT_FALSE(exists("v.mp4"));
    EXPECT_FALSE(has_temporary());
    const Bytes pid = read_file(folder_.file("pid"));
    ASSERT_GT(pid.size(), 1u);
    EXPECT_NE(::kill(std::stoi(std::string(pid.begin(), pid.end())), 0), 0) << "it still runs";
  }
}

TEST_F(Video, OfARunInterruptedBeforeItsFirstFrameIsNone) {
  with_stand_in(stand_in, "--frames 0 -o unused_#.png");
  CommandOptions options;
  options.folder = folder_.path();
  options.signal_when = [](const std::string& err) {
    return err.find("samples_done") != std::string::npos ? SIGINT : 0;
  };
  const CommandResult result = run_script("PATH=" + folder_.file("bin") +
                                              " exec $ALHAZEN render moving.gltf --size 64x64 --spp 1000000 --progress "
                                              "json --frames 0..3 --exposure 0 -o v.mp4",
                                          options);
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  EXPECT_NE(result.err.find("interrupted: no frame is finished, and no video is written"), std::string::npos)
      << result.err;
  EXPECT_FALSE(exists("v.mp4"));
}

TEST_F(Video, IsWhatFfmpegMakesOfIt) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg or ffprobe is not installed";
  const CommandResult result = run({"render", "moving.gltf", "--size", "33x25", "--spp", "4", "--progress", "none",
                                    "--frames", "0..5", "--fps", "12", "-o", "v.mp4", "-o", "v.gif"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(probed("v.mp4"), "34,26,12/1,6") << "sides are made even";
  const std::string gif = probed("v.gif");
  EXPECT_TRUE(gif.starts_with("33,25,") && gif.ends_with(",6")) << gif;
  EXPECT_FALSE(has_temporary());
}

}  // namespace

}  // namespace alhazen::impl::test
