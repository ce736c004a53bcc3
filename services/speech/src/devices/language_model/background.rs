//! Common English words of talk that is not meant for the robot.

/// Returns common English words. They are in the language model so that talk about other things is
/// recognised as such; without them every sentence would be recognised as words of the scene.
pub fn common_words() -> impl Iterator<Item = &'static str> {
    COMMON_WORDS.split_whitespace()
}

const COMMON_WORDS: &str = "\
    about above after again ago air all almost along already also always am an and another any \
    are around as ask away baby back bad be because become bed been before began behind believe \
    best better between body book both boy brother build business but buy by call called came \
    car case change child children city close come coming company country course cut daughter \
    day days dead did didn't different do does doesn't doing done door down during each early \
    eat eight end enough even evening ever every everyone everything eyes face fact family far \
    fast father feel felt few fine fire first five food foot for four friend friends full game \
    gave girl go god goes going gone good got government great group guy guys had half hand \
    happen happened happy hard has have he he's head hear heard heart hello help her here hey hi \
    high him his home hope hour hours house how hundred i'll i'm i've idea if important into its \
    job just keep kept kid kids kind knew know last late later law learn left less let let's \
    life light line listen live lot love made make makes man many matter me mean meeting men \
    might million mind minute minutes moment money month months more morning most mother move \
    much music must my myself name never new news next nice night nine nothing now number of off \
    office often oh old only open or other others our out over own paper part party people \
    person phone place play please point police president problem put question quite read ready \
    really reason remember rest road room run said same saw say says school second seem seems \
    seen sent set seven she she's should side since sister six so some someone something \
    sometimes son soon speak start state stay still story street such sun take taken talk \
    talking team tell ten than thank thanks them then there there's these they they're thing \
    things think thought thousand three through till time times to today together told tomorrow \
    tonight too took town tried trouble true try trying turn twenty two under understand until \
    up us use used very wait walk want wanted wants war was wasn't watch water way we we'll \
    we're weather week weeks well went were what what's when where which while who whole why \
    wife will with without woman women won't word words work working world would write wrong \
    year years yesterday yet you you're you've young your";

#[cfg(test)]
mod tests {
    use super::common_words;

    #[test]
    fn common_words_are_unique() {
        let mut words: Vec<&str> = common_words().collect();
        assert!(words.len() > 190);
        let len = words.len();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), len);
    }
}
