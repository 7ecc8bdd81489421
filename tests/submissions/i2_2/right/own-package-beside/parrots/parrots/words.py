WORDS = 'pretty polly'
