//! Reads the tensors of a `.safetensors` file: the length of a header in 8 bytes, the header in JSON, and little-endian numbers.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Map, Value as Json};

/// Key of the header under which the texts about the file are.
const METADATA: &str = "__metadata__";
/// Largest number of weights of a network.
pub(super) const MAX_WEIGHTS: usize = 100_000;

/// A tensor of 32-bit numbers, with the last axis fastest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tensor {
    pub shape: Vec<usize>,
    pub numbers: Vec<f32>,
}

/// The content of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TensorFile {
    pub metadata: BTreeMap<String, String>,
    pub tensors: BTreeMap<String, Tensor>,
}

#[derive(Deserialize)]
struct Entry {
    dtype: String,
    shape: Vec<usize>,
    data_offsets: [usize; 2],
}

impl TensorFile {
    /// The content of the bytes of a file; or what is wrong with them.
    pub fn parse(bytes: &[u8]) -> Result<TensorFile, String> {
        let not_one = || "is not a `.safetensors` file".to_owned();
        let (length, rest) = bytes.split_first_chunk::<8>().ok_or_else(not_one)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| not_one())?;
        let (header, numbers) = rest.split_at_checked(length).ok_or_else(not_one)?;
        let header: Map<String, Json> = serde_json::from_slice(header).map_err(|_| not_one())?;
        let mut file = TensorFile::default();
        for (name, about) in header {
            if name == METADATA {
                file.metadata = serde_json::from_value(about).map_err(|_| not_one())?;
                continue;
            }
            let entry: Entry = serde_json::from_value(about).map_err(|error| format!("tensor `{name}`: {error}"))?;
            let tensor = tensor(&entry, numbers).map_err(|fault| format!("tensor `{name}`: {fault}"))?;
            file.tensors.insert(name, tensor);
        }
        let weights: usize = file.tensors.values().map(|tensor| tensor.numbers.len()).sum();
        if weights > MAX_WEIGHTS {
            return Err(format!("has {weights} weights, and at most {MAX_WEIGHTS} are read"));
        }
        Ok(file)
    }
}

fn tensor(entry: &Entry, numbers: &[u8]) -> Result<Tensor, String> {
    if entry.dtype != "F32" {
        return Err(format!("numbers of the type {} are not read, only F32", entry.dtype));
    }
    let [begin, end] = entry.data_offsets;
    let bytes = numbers.get(begin..end).ok_or("its numbers are not in the file")?;
    let count = entry.shape.iter().try_fold(4_usize, |bytes, length| bytes.checked_mul(*length));
    if count != Some(bytes.len()) {
        return Err(format!("the shape {:?} does not fit {} bytes", entry.shape, bytes.len()));
    }
    let numbers: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    if !numbers.iter().all(|number| number.is_finite()) {
        return Err("a number is not finite".to_owned());
    }
    Ok(Tensor { shape: entry.shape.clone(), numbers })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The bytes of a file with these tensors.
    pub fn written(metadata: &[(&str, &str)], tensors: &[(&str, &[usize], &[f32])]) -> Vec<u8> {
        let metadata: BTreeMap<&str, &str> = metadata.iter().copied().collect();
        let mut header = Map::from_iter([(METADATA.to_owned(), serde_json::json!(metadata))]);
        let mut numbers = Vec::new();
        for (name, shape, values) in tensors {
            let begin = numbers.len();
            numbers.extend(values.iter().flat_map(|value| value.to_le_bytes()));
            let entry = serde_json::json!({ "dtype": "F32", "shape": shape, "data_offsets": [begin, numbers.len()] });
            header.insert((*name).to_owned(), entry);
        }
        let header = serde_json::to_vec(&header).expect("JSON");
        [&(header.len() as u64).to_le_bytes()[..], &header, &numbers].concat()
    }

    #[test]
    fn tensors_and_metadata_are_read() {
        let bytes = written(&[("action", "Continuous")], &[("a", &[2, 1], &[1.0, -2.5]), ("b", &[1], &[0.5])]);
        let file = TensorFile::parse(&bytes).expect("a file");
        assert_eq!(file.metadata["action"], "Continuous");
        assert_eq!(file.tensors["a"], Tensor { shape: vec![2, 1], numbers: vec![1.0, -2.5] });
        assert_eq!(file.tensors["b"].numbers, [0.5]);
    }

    #[test]
    fn damaged_files_are_refused() {
        let bytes = written(&[], &[("a", &[3], &[1.0, 2.0, 3.0])]);
        for length in 0..bytes.len() {
            assert!(TensorFile::parse(&bytes[..length]).is_err(), "{length} bytes");
        }
        let refused =
            |tensors: &[(&str, &[usize], &[f32])]| TensorFile::parse(&written(&[], tensors)).expect_err("refused");
        assert!(refused(&[("a", &[2], &[1.0])]).contains("does not fit"));
        assert!(refused(&[("a", &[usize::MAX, 8], &[1.0])]).contains("does not fit"));
        assert!(refused(&[("a", &[1], &[f32::NAN])]).contains("not finite"));
        let large = vec![0.0; MAX_WEIGHTS + 1];
        assert!(refused(&[("a", &[MAX_WEIGHTS + 1], &large)]).contains("at most 100000"));
        assert!(TensorFile::parse(&[0xFF; 64]).is_err());
    }
}
