# SPDX-License-Identifier: MIT
# bash completion of glint: the commands and options that the program itself names.
_glint() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}

    if [ "$COMP_CWORD" = 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" --commands 2>/dev/null) help --help --version" -- "$word")
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" "$command" --options 2>/dev/null | cut -f 1 | tr -d =)" -- "$word")
    elif [ "$before" = --lens ] || [[ $command =~ ^(info|bake|trace|render)$ && $COMP_CWORD = 2 ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" lenses --names 2>/dev/null)" -- "$word"; compgen -f -- "$word")
    elif [ "$before" = --style ]; then
        mapfile -t COMPREPLY < <(compgen -W "natural clean vintage cinema toy" -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
}
complete -o filenames -F _glint glint
