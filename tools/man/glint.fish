# SPDX-License-Identifier: MIT
# fish completion of glint: the commands, options and values that the program itself names.
function __glint_options
    set -l words (commandline -opc)
    $words[1] $words[2] --options 2>/dev/null | string replace -r '=\t' '\t'
end
function __glint_values
    set -l words (commandline -opc)
    string match -q -- '--*' $words[-1]; and $words[1] $words[2] --options=(string sub -s 3 -- $words[-1]) 2>/dev/null
end
complete -c glint -n 'test (count (commandline -opc)) -eq 1' -f -a '(glint --commands) help'
complete -c glint -n 'test (count (commandline -opc)) -gt 1; and string match -q -- "-*" (commandline -ct)' -f -a '(__glint_options)'
complete -c glint -n 'contains -- (commandline -opc)[-1] --lens; or contains -- (commandline -opc)[2] info bake trace render draw lint' -a '(glint lenses --names)'
complete -c glint -n 'test (count (commandline -opc)) -gt 2' -a '(__glint_values)'
