//! Checkpoint files: written beside and renamed, so that a file with the name is whole.

use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
};

use inroads_agents::Bag;

use super::RunError;

/// First bytes of every checkpoint; the last one is the version of the format.
const MAGIC: &[u8; 8] = b"INROADS\x01";
/// Magic, length of the rest, checksum of the rest.
const HEADER: usize = 8 + 8 + 4;
/// Checkpoints that are kept.
const KEPT: usize = 2;

/// Writes the checkpoint of `episode` into a folder, then drops the oldest.
pub(super) fn write(folder: &Path, episode: u64, bag: &Bag) -> Result<(), RunError> {
    let path = folder.join(format!("{episode:08}.ckpt"));
    let beside = path.with_extension("part");
    let body = postcard::to_stdvec(bag).expect("plain data always encodes");
    let mut file = fs::File::create(&beside).map_err(RunError::io("write", &beside))?;
    let write = |file: &mut fs::File| {
        file.write_all(MAGIC)?;
        file.write_all(&(body.len() as u64).to_le_bytes())?;
        file.write_all(&crc32fast::hash(&body).to_le_bytes())?;
        file.write_all(&body)?;
        file.sync_all()
    };
    write(&mut file).map_err(RunError::io("write", &beside))?;
    fs::rename(&beside, &path).map_err(RunError::io("write", &path))?;
    let all = list(folder)?;
    for old in &all[..all.len().saturating_sub(KEPT)] {
        fs::remove_file(old).map_err(RunError::io("remove", old))?;
    }
    Ok(())
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

/// Reads a checkpoint; what is wrong with it otherwise.
pub(super) fn read(path: &Path) -> Result<Bag, String> {
    let bytes = fs::read(path).map_err(|e| e.to_string())?;
    let (header, body) = bytes.split_at_checked(HEADER).ok_or("it is shorter than its header")?;
    let (magic, rest) = header.split_at(8);
    if magic != MAGIC {
        return Err("it does not begin like a checkpoint of this version".into());
    }
    let (length, sum) = rest.split_at(8);
    if length != (body.len() as u64).to_le_bytes() {
        return Err(format!("it was cut off: {} bytes are left", body.len()));
    }
    if sum != crc32fast::hash(body).to_le_bytes() {
        return Err("its checksum is wrong".into());
    }
    postcard::from_bytes(body).map_err(|e| e.to_string())
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
        fs::remove_dir_all(folder).unwrap();
    }
}
