# Formula for Homebrew, built from the sources of a release; the checksum is that of the archive of the tag.
class Barrelstack < Formula
  desc "Simulate wine-barrel stacks in earthquakes"
  homepage "https://github.com/barrelstack/barrelstack"
  url "https://github.com/barrelstack/barrelstack/archive/refs/tags/v0.1.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license any_of: ["MIT", "Apache-2.0"]

  depends_on "rust" => :build

  def install
    system "cargo", "install", *std_cargo_args(path: "crates/cli", features: ["xlsx"])
    generate_completions_from_executable(bin/"barrelstack", "completions")
    system bin/"barrelstack", "man", buildpath/"man"
    man1.install Dir["man/*.1"]
  end

  test do
    system bin/"barrelstack", "demo", "--variants", "8", "--out", testpath/"demo"
    assert_path_exists testpath/"demo/report.html"
  end
end
