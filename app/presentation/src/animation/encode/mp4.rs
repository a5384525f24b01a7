//! Encoding as MP4 by the program `ffmpeg`.

use std::io::{self, Read, Write};
use std::process::{Command, Stdio};

use crate::animation::pictures::Pictures;
use crate::animation::timing::{LAST_PICTURE_S, PICTURE_S};
use crate::shell::is_on_path;

/// Whether `ffmpeg` is on the path.
pub fn has_ffmpeg() -> bool {
    is_on_path("ffmpeg")
}

/// Pictures as MP4.
pub fn mp4(pictures: &dyn Pictures) -> io::Result<Vec<u8>> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("animation.mp4");
    let [width, height] = pictures.size();
    let (size, rate) = (format!("{width}x{height}"), format!("{:.3}", 1.0 / PICTURE_S));
    let mut child = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "-"])
        .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .arg(&file)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let written = child.stdin.take().map_or(Ok(()), |mut input| write_all(pictures, &mut input));
    let mut said = String::new();
    if let Some(mut errors) = child.stderr.take() {
        errors.read_to_string(&mut said)?;
    }
    if !child.wait()?.success() {
        let last = said.lines().last().unwrap_or("no message").to_owned();
        return Err(io::Error::other(format!("ffmpeg failed: {last}")));
    }
    written?;
    std::fs::read(file)
}

fn write_all(pictures: &dyn Pictures, input: &mut impl Write) -> io::Result<()> {
    let stays = (LAST_PICTURE_S / PICTURE_S) as usize;
    let last = pictures.count() - 1;
    for index in (0..last).chain(std::iter::repeat_n(last, stays)) {
        input.write_all(&pictures.draw(index).unwrap_or_default())?;
    }
    Ok(())
}
