# Completes commands, techniques, scenes and options of ssrlab in bash. `source` it, or install it where bash-completion looks.
_ssrlab()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command="" word
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        [[ $word != -* ]] && { command=$word; break; }
    done
    local names=""
    if [[ -z $command ]]; then
        names=$("$1" --help 2> /dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z-]\+\) .*/\1/p')
    elif [[ $current == -* ]]; then
        names=$("$1" "$command" --help 2> /dev/null | grep -o -- '--[a-z-]\+' | sort -u)
    elif [[ $command == show ]]; then
        names=$("$1" list 2> /dev/null | sed -n '/^\(Techniques\|Surface models\)/,/^$/ s/^  \([^ ]\+\) .*/\1/p')
    elif [[ $previous == -t || $previous == --technique || $command == check || $command == shaders || $command == export ]]; then
        names=$("$1" list 2> /dev/null | sed -n '/^Techniques/,/^$/ s/^  \([^ ]\+\) .*/\1/p')
        [[ $previous == -* ]] && names+=" exact"
    elif [[ $previous == --scene || ( $command =~ ^(render|trace|gbuffer|ray|view|plan|sources|fit)$ && $previous == "$command" ) ]]; then
        names=$("$1" list 2> /dev/null | sed -n '/^Scenes/,/^$/ s/^  \([^ ]\+\) .*/\1/p')
    fi
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$current"; compgen -f -- "$current")
    type __ltrim_colon_completions &> /dev/null && __ltrim_colon_completions "$current"
}
complete -o filenames -F _ssrlab ssrlab
