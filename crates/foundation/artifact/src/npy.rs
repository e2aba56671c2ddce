//! NumPy's `.npy` format, version 1.0, for one record type: `numpy.load` gives a structured array.
//!
//! Only files of this program are read back, so the header must be the very one that would be written: anything else is
//! a damaged entry. (The crates that read every `.npy` bring a parser generator along for the header.)

/// Bytes before the records: magic, version, header length, header padded to a multiple of 64.
fn preamble(descr: &str, count: usize) -> Vec<u8> {
    let mut header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({count},), }}");
    let unpadded = 10 + header.len() + 1;
    header.push_str(&" ".repeat(unpadded.next_multiple_of(64) - unpadded));
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes
}

/// A whole file: `records` is the packed little-endian records, `descr` NumPy's description of one.
pub(crate) fn encode(descr: &str, count: usize, records: &[u8]) -> Vec<u8> {
    let mut bytes = preamble(descr, count);
    bytes.extend(records);
    bytes
}

/// The packed records of a file that [`encode`] wrote with the same `descr`; `size` is a record's length in bytes.
pub(crate) fn decode<'a>(descr: &str, size: usize, bytes: &'a [u8]) -> Result<&'a [u8], String> {
    let length = bytes.get(8..10).map(|b| 10 + usize::from(u16::from_le_bytes([b[0], b[1]])));
    let records = length.and_then(|n| bytes.get(n..)).ok_or("the file ends within its header")?;
    if records.len() % size != 0 {
        return Err(format!("{} bytes of records are not a multiple of {size}", records.len()));
    }
    if bytes[..bytes.len() - records.len()] != preamble(descr, records.len() / size)[..] {
        return Err("the header does not describe these records".to_owned());
    }
    Ok(records)
}
