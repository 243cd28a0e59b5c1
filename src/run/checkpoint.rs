//! Checkpoint files: written beside and renamed, so that a file with the name is whole.
//!
//! Compressed, for what is remembered repeats itself: a picture mostly shows what the one before it showed.

use std::{
    fs,
    io::{self, BufWriter, Read, Seek, Write},
    path::{Path, PathBuf},
};

use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};
use inroads_agents::Bag;

use super::RunError;

/// First bytes of every checkpoint, before the version of the format.
const MAGIC: &[u8; 7] = b"INROADS";
/// The format. Version 1 was not compressed.
const VERSION: u8 = 2;
/// Magic and version, length of the rest, checksum of the rest.
const HEADER: usize = 8 + 8 + 4;
/// Checkpoints that are kept.
const KEPT: usize = 2;

/// Writes the checkpoint of `episode` into a folder, then drops the oldest.
pub(super) fn write(folder: &Path, episode: u64, bag: &Bag) -> Result<(), RunError> {
    let path = folder.join(format!("{episode:08}.ckpt"));
    let beside = path.with_extension("part");
    let file = fs::File::create(&beside).map_err(RunError::io("write", &beside))?;
    encode(file, bag).map_err(RunError::io("write", &beside))?;
    fs::rename(&beside, &path).map_err(RunError::io("write", &path))?;
    let all = list(folder)?;
    for old in &all[..all.len().saturating_sub(KEPT)] {
        fs::remove_file(old).map_err(RunError::io("remove", old))?;
    }
    Ok(())
}

/// Writes a whole file: the bag as it is compressed, never held in memory a second time, then the header before it.
fn encode(mut file: fs::File, bag: &Bag) -> io::Result<()> {
    file.write_all(&[0; HEADER])?;
    // The quickest level: pictures to a twentieth, weights to a half, in about the time that encoding takes. The next ones
    // take two to six times as long, for weights that become hardly smaller.
    let body = Sealed { file, length: 0, sum: crc32fast::Hasher::new() };
    let encoder = ZlibEncoder::new(BufWriter::new(body), Compression::fast());
    // Postcard writes byte by byte, of which the encoder takes each for a call.
    let encoder = BufWriter::with_capacity(1 << 16, encoder);
    let encoder = postcard::to_io(bag, encoder).map_err(io::Error::other)?.into_inner()?;
    let Sealed { mut file, length, sum } = encoder.finish()?.into_inner()?;
    file.rewind()?;
    file.write_all(MAGIC)?;
    file.write_all(&[VERSION])?;
    file.write_all(&length.to_le_bytes())?;
    file.write_all(&sum.finalize().to_le_bytes())?;
    file.sync_all()
}

/// A file that counts what is written and sums it up.
struct Sealed {
    file: fs::File,
    length: u64,
    sum: crc32fast::Hasher,
}

impl Write for Sealed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.sum.update(&bytes[..written]);
        self.length += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// The checkpoints of a folder, oldest first.
pub(super) fn list(folder: &Path) -> Result<Vec<PathBuf>, RunError> {
    let entries = fs::read_dir(folder).map_err(RunError::io("read", folder))?;
    let mut files: Vec<_> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "ckpt"))
        .collect();
    files.sort();
    Ok(files)
}

/// Removes all but the newest.
pub(super) fn keep_newest(folder: &Path) -> Result<(), RunError> {
    let all = list(folder)?;
    let older = &all[..all.len().saturating_sub(1)];
    older.iter().try_for_each(|file| fs::remove_file(file).map_err(RunError::io("remove", file)))
}

/// Removes the checkpoints that were written after so many episodes: a run that goes on from there has none of them.
pub(super) fn remove_after(folder: &Path, episodes: u64) -> Result<(), RunError> {
    let written = |path: &Path| path.file_stem()?.to_str()?.parse::<u64>().ok();
    for file in list(folder)?.iter().filter(|file| written(file).is_some_and(|after| after > episodes)) {
        fs::remove_file(file).map_err(RunError::io("remove", file))?;
    }
    Ok(())
}

/// Reads a checkpoint; what is wrong with it otherwise.
pub(super) fn read(path: &Path) -> Result<Bag, String> {
    let bytes = fs::read(path).map_err(|e| e.to_string())?;
    let (header, body) = bytes.split_at_checked(HEADER).ok_or("it is shorter than its header")?;
    let (magic, rest) = header.split_at(MAGIC.len());
    if magic != MAGIC {
        return Err("it does not begin like a checkpoint".into());
    }
    let (version, rest) = rest.split_at(1);
    if version != [VERSION] {
        return Err(format!(
            "it has version {} of the format, and this program reads {VERSION}; go on with the program that wrote it",
            version[0]
        ));
    }
    let (length, sum) = rest.split_at(8);
    if length != (body.len() as u64).to_le_bytes() {
        return Err(format!("it was cut off: {} bytes are left", body.len()));
    }
    if sum != crc32fast::hash(body).to_le_bytes() {
        return Err("its checksum is wrong".into());
    }
    let mut plain = Vec::new();
    ZlibDecoder::new(body).read_to_end(&mut plain).map_err(|e| e.to_string())?;
    postcard::from_bytes(&plain).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("inroads-checkpoint-{name}-{}", std::process::id()));
        let _gone = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        path
    }

    #[test]
    fn a_checkpoint_is_read_as_it_was_written_and_only_the_newest_are_kept() {
        let folder = folder("kept");
        let mut bag = Bag::default();
        bag.put("n", &7u32);
        for episode in [25, 50, 75] {
            write(&folder, episode, &bag).unwrap();
        }
        let files = list(&folder).unwrap();
        assert_eq!(files.len(), KEPT);
        assert!(files[0].ends_with("00000050.ckpt"));
        assert_eq!(read(&files[1]), Ok(bag));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_repeats_itself_takes_little_room() {
        let folder = folder("room");
        let mut bag = Bag::default();
        // A thousand pictures of which each differs from the one before it in a pixel.
        let mut picture = vec![0_u8; 4800];
        let pictures: Vec<u8> = (0..1000)
            .flat_map(|step| {
                picture[step * 4 % 4800] = step as u8;
                picture.clone()
            })
            .collect();
        bag.put("pictures", &pictures);
        write(&folder, 1, &bag).unwrap();
        let path = list(&folder).unwrap().remove(0);
        assert_eq!(read(&path), Ok(bag));
        let size = fs::metadata(&path).unwrap().len();
        assert!(size < 4_800_000 / 40, "{size} bytes");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn every_kind_of_damage_is_named() {
        let folder = folder("damage");
        let mut bag = Bag::default();
        bag.put("n", &7u32);
        write(&folder, 1, &bag).unwrap();
        let path = list(&folder).unwrap().remove(0);
        let whole = fs::read(&path).unwrap();
        let damaged = |bytes: &[u8]| {
            fs::write(&path, bytes).unwrap();
            read(&path).unwrap_err()
        };
        assert!(damaged(&whole[..5]).contains("shorter"));
        assert!(damaged(&whole[..whole.len() - 1]).contains("cut off"));
        let mut flipped = whole.clone();
        *flipped.last_mut().unwrap() ^= 1;
        assert!(damaged(&flipped).contains("checksum"));
        assert!(damaged(&vec![0; whole.len()]).contains("does not begin"));
        let mut older = whole.clone();
        older[MAGIC.len()] = 1;
        assert!(damaged(&older).contains("version 1 of the format, and this program reads 2"));
        fs::remove_dir_all(folder).unwrap();
    }
}
