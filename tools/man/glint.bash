# SPDX-License-Identifier: MIT
# bash completion of glint: the commands, options and values that the program itself names.
_glint() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]} values=

    [[ $before != --* ]] || values=$("${COMP_WORDS[0]}" "$command" --options="${before#--}" 2>/dev/null)
    if [ "$COMP_CWORD" = 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" --commands 2>/dev/null) help --help --version" -- "$word")
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" "$command" --options 2>/dev/null | cut -f 1 | tr -d =)" -- "$word")
    elif [ "$before" = --lens ] || [[ $command =~ ^(info|bake|trace|render|draw|lint)$ && $COMP_CWORD = 2 ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" lenses --names 2>/dev/null)" -- "$word"; compgen -f -- "$word")
    elif [ -n "$values" ]; then
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
}
complete -o filenames -F _glint glint
