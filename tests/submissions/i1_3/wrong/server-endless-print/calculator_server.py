while True:
    print('1) add  2) subtract  3) multiply  4) divide')
    try:
        choice = input('> ')
    except EOFError:
        continue
