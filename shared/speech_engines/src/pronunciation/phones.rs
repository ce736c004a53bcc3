//! Mapping of espeak-ng's phoneme names (`espeak-ng -x`, voice `en-us`) to the forty phones of the
//! acoustic model, which are those of the CMU pronouncing dictionary.

/// Phoneme names with their phones. In the first group `t#` and `t2` are flapped, `n-`, `r-` and
/// `l-` syllabic; in the second, names with a trailing `@` or `3` carry an American r.
const PHONES: &str = "\
    p=P b=B t=T t#=T t2=T d=D k=K x=K g=G f=F v=V T=TH D=DH s=S z=Z S=SH Z=ZH tS=CH dZ=JH h=HH \
    m=M n=N n-=AH+N N=NG l=L l-=AH+L r=R r-=R w=W j=Y \
    a=AE aa=AE a#=AH A=AA A:=AA A@=AA+R 0=AA O2=AA O=AO O:=AO O@=AO+R o@=AO+R E=EH E#=EH e@=EH+R \
    3=ER 3:=ER @=AH @-=AH @2=AH @5=AH @L=AH+L V=AH I=IH I#=IH I2=IH i=IY i:=IY i@=IY+AH i@3=IH+R \
    U=UH U@=UH+R u=UW u:=UW eI=EY aI=AY aI@=AY+AH aI3=AY+ER aU=AW aU3=AW+ER OI=OY oU=OW";

/// Returns the phones of phoneme names separated by blanks; `None` if a name is unknown, because
/// half a pronunciation is worse than none.
pub(super) fn phones(espeak: &str) -> Option<String> {
    let mut phones = Vec::new();
    for token in espeak.split_whitespace() {
        let name = token.trim_start_matches(['\'', ',', '%', '=']);
        // Pauses, glottal stops and palatal off-glides have no phone.
        if name.is_empty() || matches!(name, ";" | "?" | "_" | "_:" | "_|" | "|" | "||") {
            continue;
        }
        let mut known = PHONES.split(' ').filter_map(|pair| pair.split_once('='));
        phones.push(known.find(|(from, _)| *from == name)?.1.replace('+', " "));
    }
    (!phones.is_empty()).then(|| phones.join(" "))
}

#[cfg(test)]
mod tests {
    use super::phones;

    #[test]
    fn phones_follow_known_phonemes_without_stress() {
        for (espeak, expected) in [
            ("w '3: k t2 0 p", Some("W ER K T AA P")),
            ("'E k s a# l 'aI n d\n", Some("EH K S AH L AY N D")),
            ("b y: 9", None),
            (" _: ", None),
        ] {
            assert_eq!(phones(espeak).as_deref(), expected);
        }
    }
}
