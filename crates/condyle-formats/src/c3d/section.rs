//! The parameter section: a chain of groups and parameters, each with the way to the next.

use super::bytes::Source;
use super::parameters::{Group, Parameter, Parameters, Values, text};
use condyle_diagnostics::{Diagnostic, Place, Warnings};

/// One link of the chain.
enum Record {
    Group { id: u8, group: Group },
    Parameter { id: u8, parameter: Parameter },
}

/// Reads the groups between two places; also where the chain ends.
///
/// Each record says how far it is to the next. Where that disagrees with the record's own length, the next
/// record is where one can be: there, behind this one, or at the first place after it that looks like one.
pub(super) fn read(
    source: &Source<'_>,
    start: usize,
    limit: usize,
    warnings: &mut Warnings,
) -> (Parameters, usize) {
    let mut parameters = Parameters::default();
    let mut ids: Vec<u8> = vec![];
    let limit = limit.min(source.bytes.len());
    let mut at = start;
    while at < limit && source.u8(at).is_some_and(|length| length != 0) {
        let Some((record, end, next)) = record(source, at, limit, warnings) else {
            let name = source.i8(at).map_or(0, |length| usize::from(length.unsigned_abs()));
            match resume(source, at + 2 + name, limit) {
                Some(place) if place > at => {
                    broken(at, place, warnings);
                    at = place;
                    continue;
                }
                _ => {
                    let message = "the parameters end in the middle of one";
                    let said = Diagnostic::warning("c3d/parameter", message);
                    warnings.push(said.at(Place::at_byte(at as u64)).with_help("it is left out"));
                    break;
                }
            }
        };
        match record {
            Record::Group { id, group } => match ids.iter().position(|known| *known == id) {
                Some(index) => {
                    let known = &mut parameters.groups[index];
                    let before = std::mem::take(&mut known.parameters);
                    *known = group;
                    known.parameters = before;
                }
                None => {
                    ids.push(id);
                    parameters.groups.push(group);
                }
            },
            Record::Parameter { id, parameter } => {
                let index = ids.iter().position(|known| *known == id).unwrap_or_else(|| {
                    ids.push(id);
                    parameters.groups.push(Group::default());
                    ids.len() - 1
                });
                parameters.groups[index].parameters.push(parameter);
            }
        }
        at = match next {
            // The last of the chain.
            None if !is_record(source, end, limit) => {
                at = end;
                break;
            }
            None => end,
            Some(next) if next == end => end,
            Some(next) if is_record(source, next, limit) => next,
            Some(next) => {
                let place = if is_record(source, end, limit) || source.u8(end) == Some(0) {
                    end
                } else if next < limit && next > at && source.u8(next) == Some(0) {
                    next
                } else {
                    resume(source, end.min(next.max(at + 1)), limit).unwrap_or(end)
                };
                broken(at, place, warnings);
                place.max(at + 1)
            }
        };
    }
    (parameters, at.min(limit))
}

fn broken(at: usize, place: usize, warnings: &mut Warnings) {
    warnings.add("c3d/chain", || {
        let message = "the way from one parameter to the next is wrong";
        let said = Diagnostic::warning("c3d/chain", message).at(Place::at_byte(at as u64));
        said.with_help(format!("reading goes on at byte {place}"))
    });
}

/// The first place from here on that looks like a record.
fn resume(source: &Source<'_>, from: usize, limit: usize) -> Option<usize> {
    (from..limit).find(|&at| is_record(source, at, limit))
}

/// Whether there is something like a record: a name of letters, a group, a type that exists.
fn is_record(source: &Source<'_>, at: usize, limit: usize) -> bool {
    let (Some(length), Some(id)) = (source.i8(at), source.i8(at.saturating_add(1))) else {
        return false;
    };
    let length = usize::from(length.unsigned_abs());
    let name = at.saturating_add(2);
    let Some(letters) = source.bytes.get(name..name.saturating_add(length)) else { return false };
    let is_name = |b: &u8| b.is_ascii_graphic() || *b == b' ';
    let named = (1..=127).contains(&length)
        && id != 0
        && id != i8::MIN
        && letters.iter().all(is_name)
        && letters.first().is_some_and(|b| b.is_ascii_alphanumeric() || *b == b'_');
    let body = name + length;
    let typed = id < 0
        || source.i8(body + 2).is_some_and(|kind| matches!(kind, -1 | 1 | 2 | 4))
            && source.u8(body + 3).is_some_and(|sizes| sizes <= 7);
    named && typed && body + 3 <= limit
}

/// A record with the place behind it and that of the next, if it names one.
fn record(
    source: &Source<'_>,
    at: usize,
    limit: usize,
    warnings: &mut Warnings,
) -> Option<(Record, usize, Option<usize>)> {
    let (length, id) = (source.i8(at)?, source.i8(at + 1)?);
    if id == 0 {
        return None;
    }
    let locked = length < 0;
    let name_end = at + 2 + usize::from(length.unsigned_abs());
    let name = text(source.bytes.get(at + 2..name_end)?);
    let offset = usize::from(source.u16(name_end)?);
    let next = (offset > 0).then_some(name_end + offset);
    let body = name_end + 2;
    // A description may be missing where the next record follows at once.
    let description = |at: usize| {
        if next == Some(at) {
            return (String::new(), at);
        }
        let length = source.u8(at).map_or(0, usize::from);
        let end = (at + 1 + length).min(source.bytes.len());
        (text(source.bytes.get(at + 1..end).unwrap_or_default()), end)
    };
    if id < 0 {
        let (description, end) = description(body);
        let group = Group { name, description, locked, parameters: vec![] };
        return Some((Record::Group { id: id.unsigned_abs(), group }, end, next));
    }
    let kind = source.i8(body)?;
    let sizes_at = body + 2;
    let values_at = sizes_at + usize::from(source.u8(body + 1)?);
    let sizes = source.bytes.get(sizes_at..values_at)?.to_vec();
    let count = sizes.iter().try_fold(1usize, |product, &size| product.checked_mul(size.into()))?;
    let width = match kind {
        -1 | 1 => 1,
        2 => 2,
        4 => 4,
        _ => return None,
    };
    let end = values_at.checked_add(count.checked_mul(width)?)?;
    if end > limit {
        warnings.add("c3d/parameter", || {
            let message = format!("the values of `{name}` reach beyond the parameters");
            let said = Diagnostic::warning("c3d/parameter", message);
            said.at(Place::at_byte(at as u64)).with_help("it is left out")
        });
        return None;
    }
    let bytes = source.bytes.get(values_at..end)?;
    let values = match kind {
        -1 => Values::Letters(bytes.to_vec()),
        1 => Values::Bytes(bytes.to_vec()),
        2 => Values::Integers(
            bytes.as_chunks().0.iter().map(|b| source.processor.u16(*b) as i16).collect(),
        ),
        _ => Values::Floats(bytes.as_chunks().0.iter().map(|b| source.processor.f32(*b)).collect()),
    };
    let (description, end) = description(end);
    let parameter = Parameter { name, description, locked, sizes, values };
    Some((Record::Parameter { id: id.unsigned_abs(), parameter }, end, next))
}
